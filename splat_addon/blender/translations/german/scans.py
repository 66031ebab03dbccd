# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans and other bare points: how they become surfels, their colors, and what looks at them."""

TEXTS = {
    "3D Cursor": "3D-Cursor",
    "A crease is where planes through neighbouring points meet at more than this angle": (
        "Eine Falte ist, wo sich Ebenen durch benachbarte Punkte in einem größeren Winkel treffen"
    ),
    "A point attribute of one number, by its name": "Ein Punktattribut aus einer Zahl, nach seinem Namen",
    (
        "Add a camera that goes where the scanner went during the scene's frames: from place to place, or "
        "along the flight. At a single place it turns around once"
    ): (
        "Eine Kamera hinzufügen, die während der Einzelbilder der Szene den Weg des Scanners nimmt: von Ort "
        "zu Ort oder entlang des Fluges. An einem einzigen Ort dreht sie sich einmal um sich selbst"
    ),
    "Add a modifier that crops the surfels by a box, hides classes and thins to a spacing. Nothing stored changes": (
        "Einen Modifikator hinzufügen, der die Surfels durch einen Quader beschneidet, Klassen ausblendet und auf "
        "einen Abstand ausdünnt. Nichts Gespeichertes ändert sich"
    ),
    "Ahead": "Voraus",
    "At the middle of the surfels": "Auf die Mitte der Surfel",
    "At the Scan": "Auf den Scan",
    "At the scan from a flight, and ahead from places on the ground": (
        "Von einem Flug aus auf den Scan, von Orten am Boden aus nach vorn"
    ),
    "Attribute": "Attribut",
    "Automatic Range": "Automatischer Bereich",
    (
        "Away from the middle of each connected part, for scans of whole objects; or towards the scanner, if the file "
        "says where it stood"
    ): (
        "Weg von der Mitte jedes zusammenhängenden Teils, für Scans ganzer Objekte; "
        "oder zum Scanner hin, wenn die Datei sagt, wo er stand"
    ),
    "Camera from Scanner": "Kamera vom Scanner",
    "Classification": "Klassifizierung",
    "Color by": "Farbe nach",
    "Convert Points to Surfels": "Punkte in Surfels umwandeln",
    (
        "End surfels at edges where planes through neighbouring points meet, and give each side its own normal. "
        "It takes up to six times as long. Edges closer than about three distances between points are not told "
        "apart, and noise of a quarter of that distance hides them"
    ): (
        "Surfel an Kanten enden lassen, wo sich Ebenen durch benachbarte Punkte treffen, und jeder Seite ihre eigene "
        "Normale geben. Das dauert bis zu sechsmal so lange. Kanten, die näher als etwa drei Punktabstände beieinander "
        "liegen, werden nicht unterschieden, und Rauschen von einem Viertel dieses Abstands verbirgt sie"
    ),
    "Filter Scan": "Scan filtern",
    "Find Creases": "Falten finden",
    "Flatness": "Flachheit",
    "Flatten Noise": "Rauschen glätten",
    "From": "Von",
    "Half-axis of a splat, in distances between points. Splats too small to close a hole are enlarged": (
        "Halbachse eines Splats, in Punktabständen. Splats, die zu klein sind, um ein Loch zu schließen, "
        "werden vergrößert"
    ),
    "Height": "Höhe",
    "Hide the points in the viewport and in renders, so that only the surfels are seen": (
        "Die Punkte im Ansichtsfenster und beim Rendern verstecken, sodass nur die Surfels zu sehen sind"
    ),
    "Higher values select surfels that are less stray. 1 selects about what an import leaves out": (
        "Höhere Werte wählen weniger abseits liegende Surfels aus. 1 wählt etwa aus, was ein Import weglässt"
    ),
    "How much light came back to the scanner": "Wie viel Licht zum Scanner zurückkam",
    "In which of several scans of a file it is": "In welchem von mehreren Scans einer Datei es ist",
    "Intensity": "Intensität",
    "Keep them, with the size of their nearest neighbours": "Behalten, mit der Größe ihrer nächsten Nachbarn",
    (
        "Leave out Gaussians whose smallest radius is more than this share of their middle radius, because they "
        "are too thick for a disc. 1 leaves none out"
    ): (
        "Gaußverteilungen weglassen, deren kleinster Radius mehr als dieser Anteil ihres mittleren ist, weil sie für "
        "eine Scheibe zu dick sind. 1 lässt keine weg"
    ),
    (
        "Leave out points of a scan where another one, from less than half as far away, saw the same place more "
        "densely. Only files that say where their scanners stood have such scans"
    ): (
        "Punkte eines Scans weglassen, wo ein anderer aus weniger als halber Entfernung dieselbe Stelle dichter "
        "gesehen hat. Solche Scans haben nur Dateien, die sagen, wo ihre Scanner standen"
    ),
    "Leave the points as they are; those of a mesh appear as black dots over the surfels": (
        "Die Punkte lassen, wie sie sind; die eines Meshes erscheinen als schwarze Punkte über den Surfels"
    ),
    "Leave them out, since most are errors of the scanner": ("Weglassen, denn die meisten sind Fehler des Scanners"),
    "Look": "Blick",
    (
        "Make a surfel from every point of the selected point clouds and meshes. Missing normals, sizes and "
        "directions are estimated from neighbouring points"
    ): (
        "Aus jedem Punkt der ausgewählten Punktwolken und Meshes ein Surfel machen. Fehlende Normalen, Größen und "
        "Richtungen werden aus benachbarten Punkten geschätzt"
    ),
    (
        "Move points of noisy surfaces onto the planes through their neighbours, which smooths the surface. "
        "Points of clean scans stay where they are"
    ): (
        "Punkte verrauschter Oberflächen auf die Ebenen durch ihre Nachbarn verschieben, was die Oberfläche glättet. "
        "Punkte sauberer Scans bleiben, wo sie sind"
    ),
    "Name of a point attribute of one number": "Name eines Punktattributs aus einer Zahl",
    "Neighbours": "Nachbarn",
    "Normals Face": "Normalen nach",
    (
        "Number of neighbours from which a point's normal and size are estimated. More smooth out noise; "
        "fewer keep small details"
    ): (
        "Anzahl der Nachbarn, aus denen Normale und Größe eines Punkts geschätzt werden. Mehr glätten "
        "Rauschen; weniger erhalten kleine Details"
    ),
    "Outward": "Nach außen",
    "Own Colors": "Eigene Farben",
    "Points are converted in object mode; leave the current mode first": (
        "Punkte werden im Objektmodus umgewandelt; zuerst den jetzigen Modus verlassen"
    ),
    "Return Number": "Echonummer",
    "Scan Number": "Scan-Nummer",
    "Select a point cloud, or a mesh that is not surfels already": (
        "Eine Punktwolke auswählen oder ein Mesh, das noch nicht aus Surfels besteht"
    ),
    "Select an object of surfels, in Object Mode or Edit Mode": (
        "Ein Objekt aus Surfels auswählen, im Objekt- oder Bearbeitungsmodus"
    ),
    "Select Strays": "Streupunkte auswählen",
    "Select surfels that stand alone or are much larger than those around them, in Edit Mode; nothing is deleted": (
        "Surfels auswählen, die allein stehen oder viel größer sind als die um sie herum, im Bearbeitungsmodus; nichts "
        "wird gelöscht"
    ),
    "Select the surfels of a scan whose file tells where the scanner was": (
        "Die Surfel eines Scans auswählen, dessen Datei sagt, wo der Scanner war"
    ),
    "Selected {count:,} of {all:,} surfels; X deletes them": "{count:,} von {all:,} Surfels ausgewählt; X löscht sie",
    (
        "Show scans as they were captured, without any light: choose Surfel Splatting, Captured Color, Eye-Dome "
        "Lighting and the view transform Standard"
    ): (
        "Scans zeigen, wie sie aufgenommen wurden, ohne Licht: Surfel Splatting, Aufgenommene Farbe, "
        "Eye-Dome-Beleuchtung und die Ansichtstransformation Standard wählen"
    ),
    "Spread the ramp over all values but a few extreme ones": (
        "Den Verlauf über alle Werte außer wenigen äußersten verteilen"
    ),
    "Stray Points": "Streupunkte",
    "Texture whose color ramp the values are looked up in; without one, a ramp of even lightness": (
        "Textur, in deren Farbverlauf die Werte nachgeschlagen werden; ohne eine ein Verlauf gleichmäßiger Helligkeit"
    ),
    "The class of each point; without a ramp in colors of what it stands for": (
        "Die Klasse jedes Punktes; ohne Verlauf in Farben dessen, wofür sie steht"
    ),
    "The colors that are stored with the surfels": "Die Farben, die bei den Surfels gespeichert sind",
    "The side to which estimated normals point; existing normals are kept": (
        "Die Seite, zu der geschätzte Normalen zeigen; vorhandene Normalen bleiben"
    ),
    "The value at the left end of the ramp": "Der Wert am linken Ende des Verlaufs",
    "The value at the right end of the ramp": "Der Wert am rechten Ende des Verlaufs",
    "The world's Z": "Z der Welt",
    "Thin Overlaps": "Überlappungen ausdünnen",
    "Time": "Zeit",
    "To": "Bis",
    "Towards the 3D cursor, for scans from one place": "Zum 3D-Cursor, für Scans von einem Standpunkt aus",
    "Towards the scene's camera, for scans from one place": (
        "Zur Kamera der Szene, für Scans von einem Standpunkt aus"
    ),
    "What happens to points that are far from all others": (
        "Was mit Punkten geschieht, die weit von allen anderen entfernt sind"
    ),
    "What happens to the points that were converted": "Was mit den umgewandelten Punkten geschieht",
    "What the surfels' colors show": "Was die Farben der Surfels zeigen",
    "When it was measured": "Wann es gemessen wurde",
    "Where it goes, level": "Wohin sie sich bewegt, waagrecht",
    "Where the camera looks": "Wohin die Kamera blickt",
    "Which of several echoes of a pulse it is": "Welches von mehreren Echos eines Pulses es ist",
    "{count:,} places of the scanner, from frame {first} to {last}": (
        "{count:,} Orte des Scanners, von Einzelbild {first} bis {last}"
    ),
}
