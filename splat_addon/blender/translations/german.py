# SPDX-License-Identifier: GPL-3.0-or-later
"""German, in the words that Blender's own German interface uses."""

from __future__ import annotations

GERMAN = {
    "Aim": "Ziel",
    "Click to use": "Klick übernimmt",
    "Choose the engine Surfel Splatting first": "Wählen Sie zuerst die Engine Surfel Splatting",
    "Error": "Fehler",
    "Exact Pictures": "Exakte Bilder",
    "Go On": "Fortsetzen",
    "How often each picture is drawn to measure its time": (
        "Wie oft jedes Bild gezeichnet wird, um seine Zeit zu messen"
    ),
    "Keep what was measured before, if settings and size are the same": (
        "Behalten, was vorher gemessen wurde, wenn Einstellungen und Größe gleich sind"
    ),
    "Nothing was measured in this scene yet: measure it first": (
        "In dieser Szene wurde noch nichts gemessen: Messen Sie sie zuerst"
    ),
    "Open an image editor and choose {name!r} there": "Öffnen Sie einen Bildeditor und wählen Sie dort {name!r}",
    "Pictures that the exact one is the mean of, a multiple of 8": (
        "Bilder, deren Mittel das exakte Bild ist, ein Vielfaches von 8"
    ),
    (
        "Render the scene with many settings and compare each picture with the exact one, for a table of what they "
        "cost and gain. It takes as long as a hundred small renders; Esc ends it and keeps what was measured"
    ): (
        "Die Szene mit vielen Einstellungen rendern und jedes Bild mit dem exakten vergleichen, für eine Tabelle "
        "dessen, was sie kosten und bringen. Es dauert so lange wie hundert kleine Rendervorgänge; Esc beendet es und "
        "behält, was gemessen wurde"
    ),
    "Render with the settings of this row": "Mit den Einstellungen dieser Zeile rendern",
    "Row": "Zeile",
    "Save the table, a plot and the pictures as one HTML page, which needs no other file": (
        "Tabelle, Diagramm und Bilder als eine HTML-Seite speichern, die keine andere Datei braucht"
    ),
    "Seconds": "Sekunden",
    "Settings": "Einstellungen",
    "Show in an image editor where this row's picture differs from the exact one: black where it is equal": (
        "In einem Bildeditor zeigen, wo das Bild dieser Zeile vom exakten abweicht: schwarz, wo es gleich ist"
    ),
    "Speed and Accuracy": "Tempo und Genauigkeit",
    "Target Error": "Zielfehler",
    (
        "The closest picture that takes no longer. The first frame of a render measures the scene, which comes on top "
        "of its time"
    ): (
        "Das genaueste Bild, das nicht länger dauert. Das erste Bild eines Renderns misst die Szene, was zu "
        "seiner Zeit hinzukommt"
    ),
    (
        "The fastest picture that is as close to the exact one. The first frame of a render measures the scene, which "
        "takes about as long as a few frames"
    ): (
        "Das schnellste Bild, das dem exakten so nahe kommt. Das erste Bild eines Renderns misst die Szene, was "
        "etwa so lange dauert wie einige Bilder"
    ),
    (
        "How far a picture may be from the exact one of the same surfels, as its mean perceived difference, from 0 "
        "to 1. Few people see less than 0.01"
    ): (
        "Wie weit ein Bild vom exakten Bild derselben Surfels entfernt sein darf, als mittlerer wahrgenommener "
        "Unterschied von 0 bis 1. Weniger als 0,01 sehen nur wenige"
    ),
    "The table has {count} rows, from 0 on, and no row {row}": (
        "Die Tabelle hat {count} Zeilen, von 0 an, und keine Zeile {row}"
    ),
    "The settings below": "Die Einstellungen darunter",
    "The time that a frame may take, from reading the scene to its last sample": (
        "Die Zeit, die ein Bild dauern darf, vom Lesen der Szene bis zum letzten Sample"
    ),
    "Time Budget": "Zeitbudget",
    "Turns": "Durchgänge",
    "What decides method, samples and detail of a final render": (
        "Was Methode, Samples und Detail eines Endrenderns bestimmt"
    ),
    "Which row of the table": "Welche Zeile der Tabelle",
    "Measure This Scene": "Diese Szene messen",
    "Save Page": "Seite speichern",
    "Show Difference": "Unterschied zeigen",
    (
        "Also draw lines where surfaces of different objects cut through each other or lie in one plane. Frames "
        "take longer"
    ): (
        "Linien auch dort zeichnen, wo sich Flächen verschiedener Objekte durchdringen oder in einer Ebene "
        "liegen. Bilder dauern länger"
    ),
    "Draw lines of a width and a color of their own": "Linien in eigener Breite und Farbe zeichnen",
    "Draw no lines": "Keine Linien zeichnen",
    "Draw the lines that its materials say": "Die Linien zeichnen, die seine Materialien angeben",
    "Draw the lines that the render properties say": "Die Linien zeichnen, die die Render-Eigenschaften angeben",
    "From Materials": "Aus Materialien",
    "How the amount of light becomes a color": "Wie aus der Lichtmenge eine Farbe wird",
    "Levels of brightness": "Helligkeitsstufen",
    "Look up the light in the color ramp of a texture": "Das Licht im Farbverlauf einer Textur nachschlagen",
    "Own": "Eigene",
    "Shade it as its materials say": "Schattieren, wie es seine Materialien angeben",
    "Shade it as the render properties say, or by the ramp that its nodes have": (
        "Schattieren, wie es die Render-Eigenschaften angeben, oder mit dem Farbverlauf seiner Nodes"
    ),
    "Show the light in even steps": "Das Licht in gleichmäßigen Stufen zeigen",
    "Style": "Stil",
    (
        "Texture whose color ramp is looked up by the amount of light, from none at the left to full light at the"
        " right. Without a texture, three even greys are used"
    ): (
        "Textur, in deren Farbverlauf die Lichtmenge nachgeschlagen wird, von keinem Licht links bis zu vollem "
        "Licht rechts. Ohne Textur sind es drei gleichmäßige Grautöne"
    ),
    "The lines along its silhouettes and creases": "Die Linien entlang der Umrisse und Knicke",
    "Toon and Lines": "Toon und Linien",
    "Where Objects Meet": "Wo sich Objekte treffen",
    "Width of the lines": "Breite der Linien",
    "16 Bit": "16 Bit",
    (
        "Fade pixels to the background where their splats' weights sum to less than this. It has no effect with Mip "
        "Filter, which filters silhouettes itself. Frames take slightly longer"
    ): (
        "Pixel zum Hintergrund verlaufen lassen, wo die Summe der Gewichte ihrer Splats kleiner ist. Ohne Wirkung "
        "auf Mip Filter, der Silhouetten selbst filtert. Einzelbilder dauern etwas länger"
    ),
    (
        "Texture whose color ramp is looked up by the amount of light, from none at the left to full light at the "
        "right. Without a texture, three even greys are used. It takes as long as Toon"
    ): (
        "Textur, in deren Farbverlauf nach der Menge des Lichts nachgeschlagen wird, von keinem links bis zu vollem "
        "Licht rechts. Ohne Textur werden drei gleichmäßige Graustufen verwendet. Dauert so lange wie Toon"
    ),
    "As Printed": "Wie gedruckt",
    "As in the Papers": "Wie in den Veröffentlichungen",
    "Color Ramp": "Farbverlauf",
    ("Also draw a line where a surface is seen at less than this angle; 0 draws none. It takes no extra time"): (
        "Auch dort eine Linie zeichnen, wo eine Fläche flacher als unter diesem Winkel gesehen wird; 0 zeichnet "
        "keine. Braucht keine zusätzliche Zeit"
    ),
    (
        "Follow the papers: back faces and large splats count as much as others, EWA has its printed filter, and "
        "all surfaces that are left for the last transparent layer count as one. It takes no extra time, but far "
        "sides show at the rims of open surfaces"
    ): (
        "Den Veröffentlichungen folgen: Rückseiten und große Splats zählen so viel wie andere, EWA hat den gedruckten "
        "Filter, und alle Flächen, die für die letzte durchsichtige Schicht übrig sind, zählen als eine. Braucht keine "
        "zusätzliche Zeit, aber an Rändern offener Flächen sind abgewandte Seiten zu sehen"
    ),
    (
        "Leave out splats that face away, even on open surfaces, which then have holes. It saves up to half of the time"
    ): ("Abgewandte Splats weglassen, auch auf offenen Flächen, die dann Löcher haben. Spart bis zur Hälfte der Zeit"),
    "Leave Out Backs": "Rückseiten weglassen",
    "Light Each Splat": "Jeden Splat beleuchten",
    (
        "Light every splat by itself and blend the lit colours, as in papers before deferred shading. The time "
        "grows with the number of surfels instead of samples"
    ): (
        "Jeden Splat für sich beleuchten und die beleuchteten Farben mischen, wie in Veröffentlichungen vor dem "
        "Deferred Shading. Die Zeit wächst mit der Zahl der Surfels statt der Samples"
    ),
    (
        "Pictures per second of a viewport that moves. If they take longer, they have larger surfels and fewer "
        "pixels, until the view rests. 0 always draws all of them"
    ): (
        "Bilder pro Sekunde eines Ansichtsfensters, das sich bewegt. Dauern sie länger, haben sie größere Surfels und "
        "weniger Pixel, bis die Ansicht ruht. 0 zeichnet immer alle"
    ),
    "Viewport Rate": "Rate im Ansichtsfenster",
    "Ramp": "Verlauf",
    (
        "Sample along all three axes and keep the surfels whose smoothed normals face their axis most. It leaves "
        "small holes where normals turn, and takes longer, because every face is sampled three times"
    ): (
        "Entlang aller drei Achsen abtasten und die Surfels behalten, deren geglättete Normalen ihrer Achse am "
        "meisten zugewandt sind. Lässt kleine Löcher, wo Normalen sich drehen, und dauert länger, weil jede Fläche "
        "dreimal abgetastet wird"
    ),
    "Shallow Angle": "Flacher Winkel",
    "Surfel's Normal": "Normale des Surfels",
    "Takes less memory. Precise with hundreds of splats over a pixel, wrong with thousands": (
        "Braucht weniger Speicher. Genau bei Hunderten von Splats über einem Pixel, falsch bei Tausenden"
    ),
    "3-to-1": "3 zu 1",
    "Exact, even with thousands of splats over a pixel": ("Genau, auch bei Tausenden von Splats über einem Pixel"),
    "Takes half the memory; differences from Float 32 are invisible": (
        "Braucht halb so viel Speicher; Unterschiede zu Float 32 sind unsichtbar"
    ),
    "3D Cursor": "3D-Cursor",
    "Exact, with twice the memory of 16 Bit": "Genau, mit doppelt so viel Speicher wie 16 Bit",
    (
        "A crease is drawn where the surface turns by more than this angle within about 3 pixels; 180 "
        "degrees draws none"
    ): (
        "Eine Falte wird gezeichnet, wo sich die Fläche innerhalb von etwa 3 Pixeln um mehr als diesen Winkel "
        "dreht; 180 Grad zeichnet keine"
    ),
    "A number of grid cells along the longest edge of each object's bounding box": (
        "Eine Anzahl von Gitterzellen entlang der längsten Kante des Begrenzungsrahmens jedes Objekts"
    ),
    "A number of surfels for each object": "Eine Anzahl von Surfels für jedes Objekt",
    "Adaptive": "Adaptiv",
    "Add Surfel Conversion Preset": "Umwandlungsvoreinstellung hinzufügen",
    "Add Surfel Splatting Preset": "Surfel-Splatting-Voreinstellung hinzufügen",
    "Add a preset of all render settings of Surfel Splatting, or remove one": (
        "Eine Voreinstellung aller Rendereinstellungen von Surfel Splatting hinzufügen oder eine entfernen"
    ),
    "Add a preset of the conversion settings in the sidebar, or remove one": (
        "Eine Voreinstellung der Umwandlungseinstellungen in der Seitenleiste hinzufügen oder eine entfernen"
    ),
    "All properties, exactly; other programs read the positions, normals and colours": (
        "Alle Eigenschaften, genau; andere Programme lesen die Positionen, Normalen und Farben"
    ),
    "Ambient Occlusion": "Umgebungsverdeckung",
    "Scan Colors": "Scan-Farben",
    "Color by": "Farbe nach",
    "What the surfels' colors show": "Was die Farben der Surfels zeigen",
    "Own Colors": "Eigene Farben",
    "The colors that are stored with the surfels": "Die Farben, die bei den Surfels gespeichert sind",
    "Height": "Höhe",
    "The world's Z": "Z der Welt",
    "Intensity": "Intensität",
    "How much light came back to the scanner": "Wie viel Licht zum Scanner zurückkam",
    "Classification": "Klassifizierung",
    "The class of each point; without a ramp in colors of what it stands for": (
        "Die Klasse jedes Punktes; ohne Verlauf in Farben dessen, wofür sie steht"
    ),
    "Return Number": "Echonummer",
    "Which of several echoes of a pulse it is": "Welches von mehreren Echos eines Pulses es ist",
    "Time": "Zeit",
    "When it was measured": "Wann es gemessen wurde",
    "Scan Number": "Scan-Nummer",
    "In which of several scans of a file it is": "In welchem von mehreren Scans einer Datei es ist",
    "Attribute": "Attribut",
    "A point attribute of one number, by its name": "Ein Punktattribut aus einer Zahl, nach seinem Namen",
    "Name of a point attribute of one number": "Name eines Punktattributs aus einer Zahl",
    "Automatic Range": "Automatischer Bereich",
    "Spread the ramp over all values but a few extreme ones": (
        "Den Verlauf über alle Werte außer wenigen äußersten verteilen"
    ),
    "From": "Von",
    "To": "Bis",
    "The value at the left end of the ramp": "Der Wert am linken Ende des Verlaufs",
    "The value at the right end of the ramp": "Der Wert am rechten Ende des Verlaufs",
    "Texture whose color ramp the values are looked up in; without one, a ramp of even lightness": (
        "Textur, in deren Farbverlauf die Werte nachgeschlagen werden; ohne eine ein Verlauf gleichmäßiger Helligkeit"
    ),
    "Scan Look": "Scan-Aussehen",
    "Filter Scan": "Scan filtern",
    "Add a modifier that crops the surfels by a box, hides classes and thins to a spacing. Nothing stored changes": (
        "Einen Modifikator hinzufügen, der die Surfels durch einen Quader beschneidet, Klassen ausblendet und auf "
        "einen Abstand ausdünnt. Nichts Gespeichertes ändert sich"
    ),
    "Select Strays": "Streupunkte auswählen",
    "Select surfels that stand alone or are much larger than those around them, in Edit Mode; nothing is deleted": (
        "Surfels auswählen, die allein stehen oder viel größer sind als die um sie herum, im Bearbeitungsmodus; nichts "
        "wird gelöscht"
    ),
    "Higher values select surfels that are less stray. 1 selects about what an import leaves out": (
        "Höhere Werte wählen weniger abseits liegende Surfels aus. 1 wählt etwa aus, was ein Import weglässt"
    ),
    "Select an object of surfels, in Object Mode or Edit Mode": (
        "Ein Objekt aus Surfels auswählen, im Objekt- oder Bearbeitungsmodus"
    ),
    "Selected {count:,} of {all:,} surfels; X deletes them": "{count:,} von {all:,} Surfels ausgewählt; X löscht sie",
    (
        "Show scans as they were captured, without any light: choose Surfel Splatting, Captured Color, Eye-Dome "
        "Lighting and the view transform Standard"
    ): (
        "Scans zeigen, wie sie aufgenommen wurden, ohne Licht: Surfel Splatting, Aufgenommene Farbe, "
        "Eye-Dome-Beleuchtung und die Ansichtstransformation Standard wählen"
    ),
    (
        "Show the scan as it was captured, without any light: with Captured Color and Eye-Dome Lighting, if it is the "
        "scene's first; in colors of its intensity or height, if it has none; from a new camera, if the scene has none "
        "that sees it"
    ): (
        "Den Scan zeigen, wie er aufgenommen wurde, ohne Licht: mit aufgenommener Farbe und Eye-Dome-Beleuchtung, wenn "
        "er der erste der Szene ist; in Farben seiner Intensität oder Höhe, wenn er keine hat; von einer neuen Kamera, "
        "wenn die Szene keine hat, die ihn sieht"
    ),
    "Eye-Dome Lighting": "Eye-Dome-Beleuchtung",
    "Radius": "Radius",
    "Strength": "Stärke",
    (
        "Darken surfaces whose surroundings rise towards the viewer, with any shading and without any light. It shows "
        "the shape of scans. Frames take slightly longer"
    ): (
        "Flächen abdunkeln, deren Umgebung sich zum Betrachter hin erhebt, mit jeder Schattierung und ohne Licht. "
        "Zeigt die Form von Scans. Einzelbilder dauern etwas länger"
    ),
    "How much steps in depth darken what lies behind them": (
        "Wie sehr Stufen in der Tiefe abdunkeln, was hinter ihnen liegt"
    ),
    "How far away the eight places are that each is compared with: the width of dark rims": (
        "Wie weit die acht Stellen entfernt sind, mit denen jede verglichen wird: die Breite dunkler Ränder"
    ),
    "An image of a lit ball that fills the frame. A multilayer file shows its first layer": (
        "Ein Bild einer beleuchteten Kugel, die das Bild ausfüllt. Von einer mehrschichtigen Datei wird die "
        "erste Schicht gezeigt"
    ),
    "Angle": "Winkel",
    (
        "The surfels' own colour, multiplied by a ramp's colour for the amount of diffuse light (Botsch et al. "
        "2005, section 6)"
    ): (
        "Die eigene Farbe der Surfels, multipliziert mit der Farbe eines Verlaufs für die Menge des diffusen Lichts "
        "(Botsch et al. 2005, section 6)"
    ),
    "Three even greys, as with Toon": "Drei gleichmäßige Graustufen wie bei Toon",
    "Follow the setting Render Meshes as in the render properties": (
        "Der Einstellung Meshes als in den Rendereigenschaften folgen"
    ),
    "As fine as the scene's camera and resolution need on the current frame": (
        "So fein, wie Kamera und Auflösung der Szene es im aktuellen Einzelbild brauchen"
    ),
    (
        "As fine as the scene's camera needs on the current frame, a quarter finer where something moves. "
        "Resolution 256 where no camera sees the object, and 4,000,000 surfels at most"
    ): (
        "So fein, wie die Kamera der Szene es im aktuellen Einzelbild braucht, ein Viertel feiner, wo sich "
        "etwas bewegt. Auflösung 256, wo keine Kamera das Objekt sieht, und höchstens 4.000.000 Surfels"
    ),
    "From Scene": "Aus Szene",
    "Automatic": "Automatisch",
    (
        "Away from the middle of each connected part, for scans of whole objects; or towards the scanner, if the file "
        "says where it stood"
    ): (
        "Weg von der Mitte jedes zusammenhängenden Teils, für Scans ganzer Objekte; "
        "oder zum Scanner hin, wenn die Datei sagt, wo er stand"
    ),
    "Bake Materials": "Materialien backen",
    "Balanced": "Ausgewogen",
    "Beam Shape": "Strahlform",
    "Blend": "Mischung",
    "Blend Depth": "Mischtiefe",
    "Blend the Rest": "Rest mischen",
    "Blur Samples": "Unschärfe-Samples",
    "Bounced Light": "Indirektes Licht",
    "Bounces": "Reflexionen",
    "Broken Objects": "Fehlerhafte Objekte",
    "Camera": "Kamera",
    "Choose method and samples together": "Methode und Samples zusammen wählen",
    "Switch to Surfel Splatting as the render engine, and to Rendered shading in this 3D view": (
        "Zu Surfel Splatting als Render-Engine und in dieser 3D-Ansicht zur Schattierung Gerendert wechseln"
    ),
    "Color": "Farbe",
    "Conversion in New Scenes": "Umwandlung in neuen Szenen",
    "Convert Points to Surfels": "Punkte in Surfels umwandeln",
    "Convert to Surfels": "In Surfels umwandeln",
    "Count": "Anzahl",
    "Coverage": "Bedeckung",
    "Crease Angle": "Faltenwinkel",
    "Cryptomatte": "Cryptomatte",
    "Density": "Dichte",
    "Depth": "Tiefe",
    "Depth Threshold": "Tiefenschwelle",
    "Detail Tolerance": "Detailtoleranz",
    ("Diffuse and GGX specular light of the scene's lights and world (Walter et al. 2007, Heitz et al. 2016)"): (
        "Diffuses und glänzendes (GGX-)Licht der Lampen und der Welt (Walter et al. 2007, Heitz et al. 2016)"
    ),
    ("Diffuse light and a highlight as sharp as the material is smooth; lights are points (Blinn 1977, normalised)"): (
        "Diffuses Licht und ein Glanzlicht, so scharf, wie das Material glatt ist; Lampen sind Punkte (Blinn "
        "1977, normiert)"
    ),
    (
        "Discs in point sprites that are not blended: each pixel shows the nearest; faster than Quads (Botsch and "
        "Kobbelt 2003, sections 3.1 and 3.2)"
    ): (
        "Scheiben in Punktsprites, die nicht gemischt werden: Jedes Pixel zeigt die nächste; schneller als Quads "
        "(Botsch und Kobbelt 2003, Abschnitte 3.1 und 3.2)"
    ),
    "Disabled in Renders Before": "Zuvor vom Rendern ausgeschlossen",
    "Discs in point sprites, with holes at grazing angles (Botsch and Kobbelt 2003, sections 3.1 to 3.4)": (
        "Scheiben in Punktsprites, mit Löchern bei flachen Winkeln (Botsch und Kobbelt 2003, Abschnitte 3.1 bis 3.4)"
    ),
    "Distance": "Entfernung",
    (
        "Distance between surfels in pixels of the render, where the object comes closest to the camera. An "
        "object is sampled again when it comes much closer"
    ): (
        "Abstand zwischen den Surfels in Pixeln des Renderbilds, dort, wo das Objekt der Kamera am nächsten "
        "ist. Ein Objekt wird neu abgetastet, wenn es viel näher kommt"
    ),
    (
        "Distance between surfels in pixels of the render, where the object comes closest to the camera. "
        "Doubling it makes a quarter of the surfels"
    ): (
        "Abstand zwischen den Surfels in Pixeln des Renderbilds, dort, wo das Objekt der Kamera am nächsten "
        "ist. Der doppelte Wert ergibt ein Viertel der Surfels"
    ),
    (
        "Distance between surfels in world units, where the object's scale spreads them most. Half of it "
        "takes four times the memory and time"
    ): (
        "Abstand zwischen den Surfels in Welteinheiten, dort, wo die Skalierung des Objekts sie am weitesten "
        "auseinanderzieht. Der halbe Wert braucht viermal so viel Speicher und Zeit"
    ),
    ("Distance between surfels, in the units of the chosen space. Half of it takes four times the memory and time"): (
        "Abstand zwischen den Surfels in den Einheiten des gewählten Raums. Der halbe Wert braucht viermal "
        "so viel Speicher und Zeit"
    ),
    "Distance from the camera up to which the object is drawn as polygons": (
        "Entfernung von der Kamera, bis zu der das Objekt als Polygone gezeichnet wird"
    ),
    (
        "Draw larger surfels in place of those too small to be seen, with an error of at most this many pixels. 0 "
        "draws every surfel, and takes many times as long for large sets"
    ): (
        "Größere Surfels anstelle von solchen zeichnen, die zu klein sind, um gesehen zu werden, mit einem Fehler "
        "von höchstens so vielen Pixeln. 0 zeichnet jedes Surfel und braucht für große Mengen ein Vielfaches der "
        "Zeit"
    ),
    ("Draw lines along silhouettes and creases, with any shading. Frames take noticeably longer"): (
        "Linien entlang von Umrissen und Falten zeichnen, bei jeder Schattierung. Einzelbilder dauern merklich länger"
    ),
    ("Draw polygons up to a distance from the camera and surfels beyond it. This takes longer than surfels alone"): (
        "Bis zu einer Entfernung von der Kamera Polygone und dahinter Surfels zeichnen. Das dauert länger als"
        " Surfels allein"
    ),
    "Draw polygons where the surfels would be too far apart in the picture, and surfels elsewhere": (
        "Polygone zeichnen, wo die Surfels im Bild zu weit auseinander wären, und anderswo Surfels"
    ),
    "Draw polygons where the weights of a vertex group are 0.5 or more, and surfels elsewhere": (
        "Polygone zeichnen, wo die Gewichte einer Vertexgruppe 0,5 oder mehr sind, und anderswo Surfels"
    ),
    (
        "Draw the triangles among the splats, with the same depth, light and shadows. The alpha of the base "
        "colour's image makes holes; meshes that are transparent in another way, or whose nodes are more than images, "
        "become surfels, unless their object is set to Polygons"
    ): (
        "Die Dreiecke zwischen den Splats zeichnen, mit derselben Tiefe, demselben Licht und denselben Schatten. "
        "Das Alpha des Bildes der Grundfarbe macht Löcher; auf andere Art transparente Meshes, und solche, deren "
        "Knoten mehr als Bilder sind, werden zu Surfels, außer wenn ihr Objekt auf Polygone eingestellt ist"
    ),
    "Only for Cycles; choose another type": "Nur für Cycles; einen anderen Typ wählen",
    "Drop": "Entfernen",
    "EWA": "EWA",
    "EWA in Space": "EWA im Raum",
    ("Shows each light in a few even steps, with a sharp-edged highlight (Lake et al. 2000)"): (
        "Jede Lampe in wenigen gleichmäßigen Stufen, mit einem scharf begrenzten Glanzlicht (Lake et al. 2000)"
    ),
    "Additional Depth": "Zusätzliche Tiefe",
    (
        "How much farther behind the nearest splat others still blend with it, the same for all splats. The papers "
        "have this alone: set Blend Depth to 0"
    ): (
        "Wie viel weiter hinter dem nächsten Splat andere noch mit ihm mischen, für alle Splats gleich. Die "
        "Veröffentlichungen haben nur das: Mischtiefe dazu auf 0 setzen"
    ),
    "Filter Variance": "Filtervarianz",
    (
        "Variance of the Gaussian that filters a pixel, in square pixels, for methods that have one. Higher values "
        "are smoother. The papers have 1. Mip Filter takes at most 0.66"
    ): (
        "Varianz der Gaußkurve, die ein Pixel filtert, in Quadratpixeln, für Verfahren, die eine haben. Höhere Werte "
        "sind weicher. Die Veröffentlichungen haben 1. Mip-Filter nimmt höchstens 0,66"
    ),
    "Edge Fade": "Randverlauf",
    "End at Edges": "An Kanten enden",
    "Environment": "Umgebung",
    (
        "Exact ellipses, no smaller than the pixel's filter, with correct depth; more accurate at grazing "
        "angles (Guennebaud et al. 2006, sections 3 and 4, repaired)"
    ): (
        "Genaue Ellipsen, nicht kleiner als der Filter des Pixels, mit richtiger Tiefe; bei flachen Winkeln "
        "genauer (Guennebaud et al. 2006, Abschnitte 3 und 4, berichtigt)"
    ),
    "Exact ellipses, no smaller than the pixel's disc (Botsch et al. 2005, sections 3 and 5)": (
        "Genaue Ellipsen, nicht kleiner als die Scheibe des Pixels (Botsch et al. 2005, Abschnitte 3 und 5)"
    ),
    "Export Surfels": "Surfels exportieren",
    "Fewer samples than the viewport": "Weniger Samples als im Ansichtsfenster",
    "File Path": "Dateipfad",
    "Filepath used for reading from the file": "Dateipfad, von dem gelesen wird",
    "Filepath used for writing to the file": "Dateipfad, auf den geschrieben wird",
    "Film": "Film",
    "Filter": "Filter",
    (
        "Filtered, so that animations and fine textures are smooth and do not flicker. A sample takes longer "
        "than one of Preview; 16 samples smooth creases and polygons"
    ): (
        "Gefiltert, damit Animationen und feine Texturen glatt sind und nicht flimmern. Ein Sample dauert "
        "länger als eines der Vorschau; 16 Samples glätten Falten und Polygone"
    ),
    "Final": "Endgültig",
    "Flat": "Flach",
    "Flat 3D Gaussians, which viewers of Gaussian splats read": (
        "Flache 3D-Gaußverteilungen, die Betrachter von Gaussian Splats lesen"
    ),
    "Flatness": "Flachheit",
    "Float 16": "Float 16",
    "Float 32": "Float 32",
    "Follow Source": "Quelle folgen",
    "Gaussian Splats": "Gaussian Splats",
    "Glossy": "Glänzend",
    "Graphics Device": "Grafikgerät",
    "Grazing Angle": "Streifwinkel",
    "Grazing Rejection": "Streifende verwerfen",
    (
        "Grid cells along the longest edge of each object's bounding box. Doubling it makes four times as "
        "many surfels, and takes four times the memory and time"
    ): (
        "Gitterzellen entlang der längsten Kante des Begrenzungsrahmens jedes Objekts. Der doppelte Wert "
        "ergibt viermal so viele Surfels und braucht viermal so viel Speicher und Zeit"
    ),
    (
        "Grid cells along the longest edge of the object's bounding box. Doubling it makes four times as "
        "many surfels, and takes four times the memory and time"
    ): (
        "Gitterzellen entlang der längsten Kante des Begrenzungsrahmens. Der doppelte Wert ergibt viermal so "
        "viele Surfels und braucht viermal so viel Speicher und Zeit"
    ),
    "Half-axis of a splat, in distances between points. Splats too small to close a hole are enlarged": (
        "Halbachse eines Splats, in Punktabständen. Splats, die zu klein sind, um ein Loch zu schließen, "
        "werden vergrößert"
    ),
    (
        "Half-axis of a splat, in spacings. 1.25 covers every surface; smaller splats are sharper but leave dark "
        "specks. The papers' surfel quads have 0.5"
    ): (
        "Halbachse eines Splats, in Abständen. 1,25 bedeckt jede Fläche; kleinere Splats sind schärfer, "
        "lassen aber dunkle Punkte. Die gedruckten Quadrate haben 0,5"
    ),
    "Hidden for Surfels": "Für Surfels versteckt",
    "Hide": "Verstecken",
    "Hide the object in the viewport and in renders, so that only its surfels are seen": (
        "Das Objekt im Ansichtsfenster und beim Rendern verstecken, sodass nur seine Surfels zu sehen sind"
    ),
    "Hide the points in the viewport and in renders, so that only the surfels are seen": (
        "Die Punkte im Ansichtsfenster und beim Rendern verstecken, sodass nur die Surfels zu sehen sind"
    ),
    "Homogeneous": "Homogen",
    "Homogeneous, as Printed": "Homogen, wie gedruckt",
    "How often light is reflected from surface to surface": "Wie oft Licht von Fläche zu Fläche reflektiert wird",
    "How a splat is drawn and filtered": "Wie ein Splat gezeichnet und gefiltert wird",
    (
        "How far away a surface can be and still block the world's light; 0 for half the distance to the camera, and "
        "for none with Captured Color"
    ): (
        "Wie weit entfernt eine Fläche sein und das Licht der Welt noch abhalten kann; bei 0 halb so weit wie die "
        "Kamera, und bei Aufgenommener Farbe keine"
    ),
    (
        "How far behind the nearest splat others still blend with it, in splat radii. Lower values separate "
        "thin sheets; below 0.2 the surface breaks up"
    ): (
        "Wie weit hinter dem nächsten Splat andere sich noch mit ihm mischen, in Splatradien. Kleinere Werte "
        "trennen dünne Schichten; unter 0,2 bricht die Fläche auf"
    ),
    (
        "How far a larger surfel may be from the surface that it covers, in the units of the chosen space. Above 0,"
        " surfels also become larger across nearly flat faces, but conversion takes longer"
    ): (
        "Wie weit ein größeres Surfel von der Fläche entfernt sein darf, die es bedeckt, in den Einheiten des "
        "gewählten Raums. Über 0 werden Surfels auch über beinahe ebene Flächen hinweg größer, aber die Umwandlung "
        "dauert länger"
    ),
    ("Number of splats blended in each sample: 1 blue, 4 cyan, 16 green, 64 yellow, 256 and more red"): (
        "Anzahl der Splats, die in jedem Sample gemischt werden: 1 blau, 4 türkis, 16 grün, 64 gelb, 256 und mehr rot"
    ),
    "Number of splats blended in a sample, averaged over the pixel. Frames take slightly longer": (
        "Anzahl der Splats, die in einem Sample gemischt werden, gemittelt über den Pixel. Einzelbilder dauern etwas "
        "länger"
    ),
    "Approximate number of surfels for each object": ("Ungefähre Anzahl von Surfels für jedes Objekt"),
    (
        "How many times closer together this object's surfels are than the density says. 2 makes four times "
        "as many surfels"
    ): ("Wievielmal dichter die Surfels dieses Objekts liegen, als die Dichte sagt. 2 ergibt viermal so viele Surfels"),
    "How meshes, curves, texts and metaballs are drawn if they have not been converted": (
        "Wie Meshes, Kurven, Texte und Metabälle gezeichnet werden, die nicht umgewandelt wurden"
    ),
    "How much deeper the next surface must lie for a silhouette, in pixels at that distance": (
        "Wie viel tiefer die nächste Fläche für einen Umriss liegen muss, in Pixeln bei dieser Entfernung"
    ),
    "How much of each level blends into the next; at 0 edges are jagged": (
        "Wie viel jeder Stufe in die nächste übergeht; bei 0 sind Kanten gezackt"
    ),
    "How surfels are stored on the graphics device": "Wie Surfels auf dem Grafikgerät gespeichert werden",
    "How the distance between surfels is chosen": "Wie der Abstand zwischen den Surfels gewählt wird",
    "How the distance between the surfels of meshes is chosen": (
        "Wie der Abstand zwischen den Surfels von Meshes gewählt wird"
    ),
    "How the sums of overlapping splats are stored": "Wie die Summen überlappender Splats gespeichert werden",
    "How the surface reflects light": "Wie die Oberfläche Licht zurückwirft",
    (
        "Leave out Gaussians whose smallest radius is more than this share of their middle radius, because they "
        "are too thick for a disc. 1 leaves none out"
    ): (
        "Gaußverteilungen weglassen, deren kleinster Radius mehr als dieser Anteil ihres mittleren ist, weil sie für "
        "eine Scheibe zu dick sind. 1 lässt keine weg"
    ),
    (
        "How this object and its instances are drawn. From Scene draws its surfels instead of the object for as "
        "long as they exist"
    ): (
        "Wie dieses Objekt und seine Instanzen gezeichnet werden. Aus Szene zeichnet statt des Objekts seine "
        "Surfels, solange es sie gibt"
    ),
    "Import": "Importieren",
    "Import Surfels": "Surfels importieren",
    "Include": "Einschließen",
    "Its Emission node's colour and strength scale the light": (
        "Farbe und Stärke der Emission-Node skalieren das Licht"
    ),
    "Shown by its first layer, without highlights": "Durch die erste Schicht gezeigt, ohne Glanzlichter",
    "Join": "Zusammenführen",
    "Keep": "Behalten",
    "Keep them, with the size of their nearest neighbours": "Behalten, mit der Größe ihrer nächsten Nachbarn",
    "Kind": "Art",
    "Last Picture": "Letztes Bild",
    "Layers": "Schichten",
    "Layout": "Aufbau",
    "Leave the object as it is, in the same place as its surfels": (
        "Das Objekt lassen, wie es ist, an derselben Stelle wie seine Surfels"
    ),
    "Leave the points as they are; those of a mesh appear as black dots over the surfels": (
        "Die Punkte lassen, wie sie sind; die eines Meshes erscheinen als schwarze Punkte über den Surfels"
    ),
    "Do not draw them": "Nicht zeichnen",
    "Leave them out, since most are errors of the scanner": ("Weglassen, denn die meisten sind Fehler des Scanners"),
    (
        "Let Cycles bake material inputs that cannot be read directly, such as Ambient Occlusion. This is "
        "slow: each input may take longer than the rest of the conversion"
    ): (
        "Cycles Materialeingänge backen lassen, die nicht direkt gelesen werden können, etwa "
        "Umgebungsverdeckung. Das ist langsam: Jeder Eingang kann länger dauern als die übrige Umwandlung"
    ),
    (
        "Let Cycles bake the material inputs that cannot be read directly. This is slow: each input may take "
        "longer than the rest of the conversion"
    ): (
        "Cycles die Materialeingänge backen lassen, die nicht direkt gelesen werden können. Das ist langsam: "
        "Jeder Eingang kann länger dauern als die übrige Umwandlung"
    ),
    (
        "Let the shading normal change over each surfel. Surfels that are several pixels large are lit more like "
        "the curved surface that they stand for, but take slightly more memory"
    ): (
        "Die Normale der Schattierung über jedem Surfel ändern. Surfels, die mehrere Pixel groß sind, werden eher "
        "wie die gekrümmte Fläche beleuchtet, für die sie stehen, brauchen aber etwas mehr Speicher"
    ),
    ("Let visible surfaces block the world's light from one another. Frames take slightly longer"): (
        "Sichtbare Flächen das Licht der Welt voneinander abhalten lassen. Einzelbilder dauern etwas länger"
    ),
    ("Let glossy objects reflect what stands around them. It is drawn from each of them when it has changed"): (
        "Glänzende Objekte spiegeln lassen, was um sie herum steht. Es wird von jedem aus gezeichnet, wenn es sich "
        "geändert hat"
    ),
    (
        "Let glass show what stands behind it, bent, tinted and blurred; otherwise it is opaque. What is behind is "
        "drawn again for each view"
    ): (
        "Glas zeigen lassen, was dahinter steht, gebrochen, gefärbt und unscharf; sonst ist es undurchsichtig. Was "
        "dahinter ist, wird für jede Ansicht neu gezeichnet"
    ),
    (
        "Let surfaces light one another, and keep the world's light from one another. It is computed for the whole "
        "scene when that has changed, which takes some seconds, and takes the place of Ambient Occlusion"
    ): (
        "Flächen einander beleuchten und das Licht der Welt voneinander abhalten lassen. Es wird für die ganze Szene "
        "berechnet, wenn sie sich geändert hat, was einige Sekunden dauert, und ersetzt Umgebungsverdeckung"
    ),
    "Levels": "Stufen",
    "Levels of brightness that each light is shown in": "Helligkeitsstufen, in denen jede Lampe gezeigt wird",
    "Light": "Licht",
    "Lines": "Linien",
    (
        "Look up the base colour's image for every pixel instead of once per surfel. Textures are much "
        "sharper, but frames take several times as long without a graphics card"
    ): (
        "Das Bild der Grundfarbe für jeden Pixel nachschlagen statt einmal pro Surfel. Texturen werden viel "
        "schärfer, aber Einzelbilder dauern ohne Grafikkarte um ein Mehrfaches länger"
    ),
    (
        "Make a surfel from every point of the selected point clouds and meshes. Missing normals, sizes and "
        "directions are estimated from neighbouring points"
    ): (
        "Aus jedem Punkt der ausgewählten Punktwolken und Meshes ein Surfel machen. Fehlende Normalen, Größen und "
        "Richtungen werden aus benachbarten Punkten geschätzt"
    ),
    (
        "Make one surfel object of the whole selection, in the place of the active object. The density then "
        "refers to the whole"
    ): (
        "Aus der ganzen Auswahl ein einziges Surfelobjekt an der Stelle des aktiven Objekts machen. Die "
        "Dichte bezieht sich dann auf das Ganze"
    ),
    "Matcap": "Matcap",
    "Measure how long each pass takes, by waiting for the graphics device after each": (
        "Messen, wie lange jeder Durchgang braucht, indem nach jedem auf das Grafikgerät gewartet wird"
    ),
    (
        "Maximum memory in megabytes that a final render, and each 3D view, may use on the graphics device. A"
        " picture that needs more stops with a message. 0 sets no limit"
    ): (
        "Höchster Speicher in Megabyte, den ein endgültiges Rendern und jede 3D-Ansicht auf dem Grafikgerät "
        "belegen dürfen. Ein Bild, das mehr braucht, bricht mit einer Meldung ab. 0 setzt keine Grenze"
    ),
    "Memory of a Picture": "Speicher eines Bilds",
    "Meshes": "Meshes",
    "Method": "Methode",
    "Mip Filter": "Mip-Filter",
    "Mix all surfaces behind the last layer by their opacity, without sorting them. If off, they are left out": (
        "Alle Flächen hinter der letzten Schicht nach ihrer Deckkraft mischen, ohne sie zu sortieren. Sonst "
        "werden sie weggelassen"
    ),
    (
        "Number of times during the open shutter at which the scene is evaluated. Fewer are faster, but show "
        "moving objects as separate pictures"
    ): (
        "Anzahl der Zeitpunkte des offenen Verschlusses, an denen die Szene ausgewertet wird. Weniger sind "
        "schneller, zeigen aber bewegte Objekte als einzelne Bilder"
    ),
    "Motion Blur": "Bewegungsunschärfe",
    "Neighbours": "Nachbarn",
    (
        "No filter: fast, and with many samples the sharpest (View-independent object-space surface "
        "splatting, sections 4.1 to 4.3)"
    ): (
        "Kein Filter: schnell und mit vielen Samples am schärfsten (View-independent object-space "
        "surface splatting, Abschnitte 4.1 bis 4.3)"
    ),
    "Nodes": "Nodes",
    "None": "Keine",
    "Normal": "Normale",
    "Normals": "Normalen",
    "Normals Face": "Normalen nach",
    "Not Sampled": "Nicht abgetastet",
    "Shape": "Form",
    "Nothing": "Nichts",
    "Find Creases": "Falten finden",
    "Flatten Noise": "Rauschen glätten",
    (
        "Move points of noisy surfaces onto the planes through their neighbours, which smooths the surface. "
        "Points of clean scans stay where they are"
    ): (
        "Punkte verrauschter Oberflächen auf die Ebenen durch ihre Nachbarn verschieben, was die Oberfläche glättet. "
        "Punkte sauberer Scans bleiben, wo sie sind"
    ),
    "Thin Overlaps": "Überlappungen ausdünnen",
    (
        "Leave out points of a scan where another one, from less than half as far away, saw the same place more "
        "densely. Only files that say where their scanners stood have such scans"
    ): (
        "Punkte eines Scans weglassen, wo ein anderer aus weniger als halber Entfernung dieselbe Stelle dichter "
        "gesehen hat. Solche Scans haben nur Dateien, die sagen, wo ihre Scanner standen"
    ),
    (
        "End surfels at edges where planes through neighbouring points meet, and give each side its own normal. "
        "It takes up to six times as long. Edges closer than about three distances between points are not told "
        "apart, and noise of a quarter of that distance hides them"
    ): (
        "Surfel an Kanten enden lassen, wo sich Ebenen durch benachbarte Punkte treffen, und jeder Seite ihre eigene "
        "Normale geben. Das dauert bis zu sechsmal so lange. Kanten, die näher als etwa drei Punktabstände beieinander "
        "liegen, werden nicht unterschieden, und Rauschen von einem Viertel dieses Abstands verbirgt sie"
    ),
    "A crease is where planes through neighbouring points meet at more than this angle": (
        "Eine Falte ist, wo sich Ebenen durch benachbarte Punkte in einem größeren Winkel treffen"
    ),
    (
        "Number of neighbours from which a point's normal and size are estimated. More smooth out noise; "
        "fewer keep small details"
    ): (
        "Anzahl der Nachbarn, aus denen Normale und Größe eines Punkts geschätzt werden. Mehr glätten "
        "Rauschen; weniger erhalten kleine Details"
    ),
    (
        "Number of pictures that a final render averages, each with another offset in the pixel, on the lens "
        "and in time. The time grows with the number"
    ): (
        "Anzahl der Bilder, über die ein endgültiges Rendern mittelt, jedes mit einem anderen Versatz im "
        "Pixel, auf der Linse und in der Zeit. Die Zeit wächst mit der Anzahl"
    ),
    "Number of pictures that the viewport averages while nothing changes": (
        "Anzahl der Bilder, über die das Ansichtsfenster mittelt, solange sich nichts ändert"
    ),
    (
        "Number of transparent surfaces behind one another that are sorted exactly. Each takes about the "
        "time of an opaque frame"
    ): (
        "Anzahl transparenter Flächen hintereinander, die genau sortiert werden. Jede braucht etwa die Zeit "
        "eines deckenden Einzelbilds"
    ),
    "Object": "Objekt",
    "Object Detail": "Objektdetail",
    "Color of the lines": "Farbe der Linien",
    "Origin of the surfels, in the space of the first source": "Ursprung der Surfels, im Raum der ersten Quelle",
    "Origin": "Ursprung",
    "Outward": "Nach außen",
    "Overdraw": "Überzeichnung",
    "Override": "Überschreiben",
    "Panorama": "Panorama",
    "Passes": "Durchgänge",
    "Performance": "Leistung",
    "Persistent Data": "Beständige Daten",
    "Phong": "Phong",
    "Phong Splatting": "Phong-Splatting",
    "Pixels per Surfel": "Pixel pro Surfel",
    "Plan": "Plan",
    "Points": "Punkte",
    "Polygons": "Polygone",
    "Position": "Position",
    "Preparing surfels": "Surfels werden vorbereitet",
    "Compiling shaders": "Shader werden kompiliert",
    "Preset": "Voreinstellung",
    "Preview": "Vorschau",
    "Principled": "Principled",
    "Quads": "Quads",
    "Ray Cast": "Raycast",
    "Ray Cast, as Printed": "Raycast, wie gedruckt",
    "Ray Visibility": "Strahlensichtbarkeit",
    (
        "Read surfels from files: those written by this extension, Gaussian splats, or scans; what a file is, its "
        "contents tell"
    ): (
        "Surfels aus Dateien lesen: aus von dieser Erweiterung geschriebenen, aus Gaussian Splats oder aus Scans; was "
        "eine Datei ist, sagt ihr Inhalt"
    ),
    "Surfels and Scans": "Surfels und Scans",
    "Surfels and Scans (.ply, .las, ...)": "Surfels und Scans (.ply, .las, ...)",
    "Offset of the coordinates: {offset}": "Versatz der Koordinaten: {offset}",
    "Reading {count:,} points   Esc cancels": "{count:,} Punkte gelesen   Esc bricht ab",
    "The import was cancelled; nothing was changed": "Der Import wurde abgebrochen; nichts wurde verändert",
    "Took {offset} from the coordinates; later files share that offset": (
        "{offset} von den Koordinaten abgezogen; spätere Dateien haben denselben Versatz"
    ),
    "Reduction": "Reduktion",
    "Reflections": "Spiegelungen",
    "Refraction": "Lichtbrechung",
    "Render Meshes as": "Meshes als",
    "Render as": "Rendern als",
    "Render without them, and name them in a warning": "Ohne sie rendern und sie in einer Warnung nennen",
    "Resolution": "Auflösung",
    "Sample along all three axes and keep every sample": ("Entlang aller drei Achsen abtasten und jede Probe behalten"),
    (
        "Sample along all three axes and keep one surfel at each node of a lattice (Pfister's reduction). "
        "Surfels move up to half a spacing off the surface"
    ): (
        "Entlang aller drei Achsen abtasten und an jedem Gitterpunkt ein Surfel behalten (Pfisters "
        "Reduktion). Surfels weichen bis zu einem halben Abstand von der Fläche ab"
    ),
    (
        "Sample along all three axes, except where a face is seen at a grazing angle (Zwicker's reduction). "
        "Most surfaces are sampled more than once"
    ): (
        "Entlang aller drei Achsen abtasten, außer wo eine Fläche streifend gesehen wird (Zwickers "
        "Reduktion). Die meisten Flächen werden mehrfach abgetastet"
    ),
    "Sample each face along the axis that it faces most. It leaves no holes and is the fastest": (
        "Jede Fläche entlang der Achse abtasten, der sie am meisten zugewandt ist. Das lässt keine Löcher "
        "und ist am schnellsten"
    ),
    (
        "Sample the mesh when it is first drawn; its surfels follow it as it deforms. Frames in which it "
        "deforms take longer"
    ): (
        "Das Mesh abtasten, wenn es zum ersten Mal gezeichnet wird; seine Surfels folgen ihm, wenn es sich "
        "verformt. Einzelbilder, in denen es sich verformt, dauern länger"
    ),
    (
        "Convert the selected objects, with their modifiers, to surfel objects in exactly the same place. It "
        "converts meshes, curves, texts, metaballs, and the instances of Geometry Nodes and collections"
    ): (
        "Die ausgewählten Objekte mit ihren Modifikatoren in Surfelobjekte an genau derselben Stelle umwandeln: "
        "Meshes, Kurven, Texte, Metabälle und die Instanzen von Geometry Nodes und Sammlungen"
    ),
    "Samples": "Samples",
    (
        "Samples along each side of a pixel in final renders, so 3 means 9 samples. Use 1 with Mip Filter; "
        "with Quads, more samples are sharper and slower"
    ): (
        "Samples entlang jeder Seite eines Pixels beim endgültigen Rendern, 3 bedeutet also 9 Samples. Beim "
        "Mip-Filter 1 verwenden; bei Quads sind mehr Samples schärfer und langsamer"
    ),
    "Samples along each side of a pixel in the viewport": (
        "Samples entlang jeder Seite eines Pixels im Ansichtsfenster"
    ),
    (
        "Drop samples where the normal of the surface is more than this angle away from the axis of sampling. "
        "90 degrees keeps all samples"
    ): (
        "Proben weglassen, wo die Normale der Fläche um mehr als diesen Winkel von der Achse der Abtastung abweicht. "
        "90 Grad behält alle Proben"
    ),
    "Sampling": "Sampling",
    "Selected Only": "Nur Auswahl",
    "Shading": "Schattierung",
    "Shadow": "Schatten",
    "Sun": "Sonne",
    "Threshold": "Schwellenwert",
    "Shadows": "Schatten",
    "Shared by all lights": "Für alle Lichter gemeinsam",
    "Show with Surfel Splatting": "Mit Surfel Splatting zeigen",
    (
        "Filters each splat exactly: smooth and free of flicker at one sample per pixel, slower than Quads "
        "(this project, after Zwicker et al. 2001)"
    ): (
        "Filtert jeden Splat genau: glatt und flimmerfrei bei einem Sample pro Pixel, langsamer als Quads "
        "(dieses Projekt, nach Zwicker et al. 2001)"
    ),
    "Softness": "Weichheit",
    "Source": "Quelle",
    "Space": "Raum",
    "Spacing": "Abstand",
    "Splat Size": "Splatgröße",
    "Split by Distance": "Nach Entfernung teilen",
    "Split by Spacing": "Nach Abstand teilen",
    "Split by Vertex Group": "Nach Vertexgruppe teilen",
    "Sprites": "Sprites",
    "Sprites, Unfiltered": "Sprites, ungefiltert",
    "Sprites, as Printed": "Sprites, wie gedruckt",
    "Steps": "Stufen",
    "Stop": "Abbrechen",
    "Stop in Background": "Im Hintergrund abbrechen",
    "Stop in the background, so that a render farm notices; warn in the interface": (
        "Im Hintergrund abbrechen, damit eine Renderfarm es bemerkt; in der Oberfläche warnen"
    ),
    "Stop the render": "Das Rendern abbrechen",
    "Stray Points": "Streupunkte",
    "Supersampling": "Supersampling",
    "Surface": "Oberfläche",
    "Surfaces": "Flächen",
    "Surfel Conversion Presets": "Umwandlungsvoreinstellungen",
    "Surfel Splatting": "Surfel Splatting",
    "Surfel Splatting Preset": "Surfel-Splatting-Voreinstellung",
    "Surfel Splatting Presets": "Surfel-Splatting-Voreinstellungen",
    "Surfel Storage": "Surfelspeicher",
    "Surfels": "Surfels",
    "Surfels (.ply)": "Surfels (.ply)",
    (
        "End surfels at creases, at borders between colours and at open borders, and make their blend depth no "
        "larger than their surface needs. Edges stay sharp, but conversion takes longer, and frames take slightly "
        "longer"
    ): (
        "Surfels an Falten, Farbgrenzen und offenen Rändern enden lassen und ihre Mischtiefe nicht größer "
        "machen, als ihre Fläche braucht. Kanten bleiben scharf, aber die Umwandlung dauert länger und Einzelbilder "
        "etwas länger"
    ),
    "Temperature": "Temperatur",
    ("Texels along each side of a shadow map; 0 turns shadows off. Each light with shadows adds one or several maps"): (
        "Texel entlang jeder Seite einer Schattenkarte; 0 schaltet Schatten aus. Jede Lampe mit Schatten fügt"
        " eine oder mehrere Karten hinzu"
    ),
    "Text": "Text",
    "Texture-Mapped": "Mit Texturen",
    "The classic filter, in screen space; blurs silhouettes (Zwicker et al. 2001, Ren et al. 2002)": (
        "Der klassische Filter, im Bildraum; macht Umrisse unscharf (Zwicker et al. 2001, Ren et al. 2002)"
    ),
    (
        "The direction that the surface faces in the world, with -1 to 1 on each axis shown as 0 to 1 of red,"
        " green and blue"
    ): (
        "Die Richtung in der Welt, in die die Fläche zeigt, mit -1 bis 1 auf jeder Achse als 0 bis 1 von Rot,"
        " Grün und Blau"
    ),
    ("The distance along the view, from black at the nearest visible surface to white at the farthest"): (
        "Die Entfernung in Blickrichtung, von Schwarz an der nächsten sichtbaren Fläche bis Weiß an der fernsten"
    ),
    ("The fastest picture without holes: unfiltered, so edges and textures are jagged"): (
        "Das schnellste Bild ohne Löcher: ungefiltert, daher mit gezackten Kanten und Texturen"
    ),
    (
        "Minimum number of samples of a final render with depth of field or motion blur, because a single sample "
        "shows no blur. Set it to 1 so that only Samples counts"
    ): (
        "Mindestzahl der Samples eines endgültigen Renderns mit Tiefen- oder Bewegungsunschärfe, weil ein "
        "einzelnes Sample keine Unschärfe zeigt. Auf 1 setzen, damit allein Samples zählt"
    ),
    "The object is drawn as polygons where its surfels are more pixels apart than this": (
        "Das Objekt wird als Polygone gezeichnet, wo seine Surfels mehr Pixel auseinander sind als dieser Wert"
    ),
    "The object is drawn as polygons where its weights are 0.5 or more": (
        "Das Objekt wird als Polygone gezeichnet, wo ihre Gewichte 0,5 oder mehr sind"
    ),
    "The object's own space, so that its scale also scales the spacing": (
        "Der Raum des Objekts selbst, dessen Skalierung dann auch den Abstand skaliert"
    ),
    (
        "Uses the paper's own formulas: splats have half their size, and wrong depths where they are tilted "
        "(Botsch and Kobbelt 2003, equations 1 and 4 as printed)"
    ): (
        "Verwendet die Formeln des Artikels: Splats haben die halbe Größe und, wo sie geneigt sind, falsche Tiefen "
        "(Botsch und Kobbelt 2003, Gleichungen 1 und 4 wie gedruckt)"
    ),
    (
        "Uses the paper's own formulas: discs that face the ray vanish, and small ones lose their depth "
        "(Guennebaud et al. 2006, sections 3 and 4, equations 8 to 10)"
    ): (
        "Verwendet die Formeln des Artikels: Dem Strahl zugewandte Scheiben verschwinden, und kleine "
        "verlieren ihre Tiefe (Guennebaud et al. 2006, Abschnitte 3 und 4, Gleichungen 8 bis 10)"
    ),
    "The same distance between surfels in every object": ("Derselbe Abstand zwischen den Surfels in allen Objekten"),
    (
        "EWA computed in each splat's plane, which is drawn as a larger quad (Ren et al. 2002; "
        "view-independent object-space surface splatting, section 3, equation 10)"
    ): (
        "EWA, in der Ebene jedes Splats berechnet, der als größeres Quad gezeichnet wird (Ren et al. 2002; "
        "View-independent object-space surface splatting, Abschnitt 3, Gleichung 10)"
    ),
    "The share of each pixel that surfaces cover, regardless of the background": (
        "Der Anteil jedes Pixels, den Flächen bedecken, unabhängig vom Hintergrund"
    ),
    (
        "The sharpest, for stills and for pictures that are scaled down later. Takes two to three times as long "
        "as Preview; raise Supersampling to 5 for detail far below a pixel"
    ): (
        "Am schärfsten, für Standbilder und für Bilder, die später verkleinert werden. Dauert zwei- bis "
        "dreimal so lange wie die Vorschau; für Details weit unter einem Pixel Supersampling auf 5 erhöhen"
    ),
    "The side to which estimated normals point; existing normals are kept": (
        "Die Seite, zu der geschätzte Normalen zeigen; vorhandene Normalen bleiben"
    ),
    "The space in which surfels are spaced evenly and lengths are measured": (
        "Der Raum, in dem Surfels gleichmäßig verteilt und Längen gemessen werden"
    ),
    (
        "Draws each splat in the paper's square, which cuts off its filter, and cuts large splats away from the "
        "axis (Botsch et al. 2005, sections 3 and 5, within the paper's square)"
    ): (
        "Zeichnet jeden Splat im Quadrat der Veröffentlichung, das seinen Filter abschneidet, und große Splats "
        "abseits der Achse beschneidet (Botsch et al. 2005, Abschnitte 3 und 5, im Quadrat des Artikels)"
    ),
    "A crease is where the surface or its shading turns by more than this angle. Beside faces that are "
    "larger than a surfel a smaller angle is enough, down to a sixth of this one": (
        "Eine Falte ist, wo sich die Fläche oder ihre Schattierung um mehr als diesen Winkel dreht. Neben Flächen, "
        "die größer als ein Surfel sind, genügt ein kleinerer Winkel, bis zu einem Sechstel von diesem"
    ),
    (
        "Let the surfels follow their source, with its parent, animation and constraints. If off, they are a "
        "frozen copy"
    ): (
        "Die Surfels ihrer Quelle folgen lassen, mit deren Übergeordnetem, Animation und Einschränkungen. "
        "Sonst sind sie eine eingefrorene Kopie"
    ),
    (
        "The surfels' own colour, multiplied by an image of a ball, looked up where the ball faces the same way "
        "(Sloan et al. 2001)"
    ): (
        "Die eigene Farbe der Surfels, multipliziert mit dem Bild einer Kugel, nachgeschlagen, wo die Kugel in "
        "dieselbe Richtung zeigt (Sloan et al. 2001)"
    ),
    "Captured Color": "Aufgenommene Farbe",
    (
        "The surfels' own colour without any light, as a scan captured it; Ambient Occlusion darkens it, and lights "
        "add diffuse light"
    ): (
        "Die Farbe der Surfels selbst ohne Licht, wie ein Scan sie aufgenommen hat; Umgebungsverdeckung dunkelt sie "
        "ab, und Lampen fügen diffuses Licht hinzu"
    ),
    "The surfels' own colour, unlit": ("Die Farbe der Surfels selbst, unbeleuchtet"),
    ("The sum of the splats' weights in each sample: 1/16 blue, 1/4 cyan, 1 green, 4 yellow, 16 and more red"): (
        "Die Summe der Gewichte der Splats in jedem Sample: 1/16 blau, 1/4 türkis, 1 grün, 4 gelb, 16 und mehr rot"
    ),
    "Their points were taken": "Ihre Punkte wurden übernommen",
    "Their surfaces were sampled": "Ihre Flächen wurden abgetastet",
    "This object was already disabled in renders when it was converted, and stays so": (
        "Dieses Objekt war bei der Umwandlung schon vom Rendern ausgeschlossen und bleibt es"
    ),
    "This object was hidden when it was converted, and comes back when its surfels are deleted": (
        "Dieses Objekt wurde bei der Umwandlung versteckt und kommt wieder, wenn seine Surfels gelöscht werden"
    ),
    "Time Each Pass": "Durchgänge messen",
    "Times": "Zeiten",
    "Tint": "Tönung",
    "Tolerance": "Toleranz",
    "Toon": "Toon",
    "Towards the 3D cursor, for scans from one place": "Zum 3D-Cursor, für Scans von einem Standpunkt aus",
    "Towards the scene's camera, for scans from one place": (
        "Zur Kamera der Szene, für Scans von einem Standpunkt aus"
    ),
    "Transparency": "Transparenz",
    "Transparent": "Transparent",
    "Update Surfels from Source": "Surfels aus Quelle aktualisieren",
    "Use": "Verwenden",
    "Vertex Group": "Vertexgruppe",
    "Viewport": "Ansichtsfenster",
    "Viewport Samples": "Samples der Ansicht",
    "Viewport Supersampling": "Supersampling der Ansicht",
    "Warn": "Warnen",
    "Weight": "Gewicht",
    (
        "What happens to a final render when an object or a light cannot be drawn. A render that stops "
        "writes no file, and Blender in the background ends with exit code 1"
    ): (
        "Was mit einem endgültigen Rendern geschieht, wenn ein Objekt oder eine Lampe nicht gezeichnet "
        "werden kann. Ein abgebrochenes Rendern schreibt keine Datei, und Blender im Hintergrund endet mit "
        "Rückgabewert 1"
    ),
    "What happens to points that are far from all others": (
        "Was mit Punkten geschieht, die weit von allen anderen entfernt sind"
    ),
    "What happens to the object that was converted": "Was mit dem Objekt geschieht, das umgewandelt wurde",
    "What happens to the points that were converted": "Was mit den umgewandelten Punkten geschieht",
    "What the file holds": "Was die Datei enthält",
    "What it was made of when it was converted, as checksums": (
        "Woraus es bestand, als es umgewandelt wurde, als Prüfsummen"
    ),
    "Material inputs that could not be read, one per line": (
        "Materialeingänge, die nicht gelesen werden konnten, einer pro Zeile"
    ),
    "Whether surfaces or points of the sources were converted": "Ob Flächen oder Punkte der Quellen umgewandelt wurden",
    "The surface is sampled along three axes; this chooses which of these samples become surfels": (
        "Die Fläche wird entlang von drei Achsen abgetastet; dies wählt, welche dieser Proben zu Surfels werden"
    ),
    "The balance between speed and accuracy": "Das Verhältnis von Geschwindigkeit und Genauigkeit",
    "Width": "Breite",
    "Width of the lines. At a silhouette a line lies on the nearer surface; at a crease it covers both sides": (
        "Breite der Linien. An einem Umriss liegt eine Linie auf der näheren Fläche; an einer Falte bedeckt sie beide "
        "Seiten"
    ),
    "World": "Welt",
    "World space, so that scaled objects are as dense as others; the surfel object has a scale of 1": (
        "Weltraum, in dem skalierte Objekte so dicht sind wie andere; das Surfelobjekt hat die Skalierung 1"
    ),
    "Write a text file, which is several times as large. Surfels only": (
        "Eine Textdatei schreiben, die um ein Mehrfaches größer ist. Nur Surfels"
    ),
    "Write surfels to a PLY file, either losslessly or as Gaussian splats": (
        "Surfels in eine PLY-Datei schreiben, verlustfrei oder als Gaussian Splats"
    ),
    "Write the selected surfel objects, and not all visible ones": (
        "Die ausgewählten Surfelobjekte schreiben, nicht alle sichtbaren"
    ),
    "Conversion": "Umwandlung",
    "mesh": "Mesh",
    "points": "Punkte",
    "sources": "Quellen",
    "Choose the render engine {engine} to see the surfels": (
        "Die Render-Engine {engine} wählen, um die Surfels zu sehen"
    ),
    "Storing surfels: {percent:.0f}%   Esc cancels": "Surfels werden gespeichert: {percent:.0f}%   Esc bricht ab",
    "Storing was cancelled; nothing was changed": "Das Speichern wurde abgebrochen; nichts wurde geändert",
    "The surfels belong to a linked file; store them there": (
        "Die Surfels gehören zu einer verknüpften Datei; dort speichern"
    ),
    "Select an object whose surfels are in the .blend, in Object Mode": (
        "Im Objektmodus ein Objekt auswählen, dessen Surfels in der .blend-Datei sind"
    ),
    "{count:,} surfels -> {path}": "{count:,} Surfels -> {path}",
    "Store Surfels in a File": "Surfels in einer Datei speichern",
    "Move the surfels to a file beside the .blend, from which each view reads what it needs": (
        "Die Surfels in eine Datei neben der .blend-Datei verschieben, aus der jede Ansicht liest, was sie braucht"
    ),
    "Surfel File": "Surfel-Datei",
    (
        "File from which views read the surfels that they need. The mesh has the coarsest ones, which are drawn while "
        "the file is missing"
    ): (
        "Datei, aus der Ansichten die Surfels lesen, die sie brauchen. Das Mesh hat die gröbsten, die gezeichnet "
        "werden, solange die Datei fehlt"
    ),
    "Memory of a Surfel File": "Speicher einer Surfel-Datei",
    (
        "Maximum memory in megabytes that a final render, and each 3D view, may use for the surfels of each file that "
        "they are read from. Parts of a picture that need more are drawn coarser"
    ): (
        "Höchstens so viele Megabyte Speicher darf ein endgültiger Render und jede 3D-Ansicht für die Surfels jeder "
        "Datei benutzen, aus der sie gelesen werden. Teile eines Bildes, die mehr brauchen, werden gröber gezeichnet"
    ),
    (
        "Blender keeps places so far out in steps of {step:.3g}, also those of cameras and lights; this engine draws "
        "and exports the surfels exactly"
    ): (
        "Blender merkt sich Orte so weit draußen in Schritten von {step:.3g}, auch die von Kameras und Lichtern; diese "
        "Engine zeichnet und exportiert die Surfels genau"
    ),
    "Other engines show these surfels {aside:.2g} aside": "Andere Engines zeigen diese Surfels {aside:.2g} daneben",
    "Float Colors": "Fließkommafarben",
    "What the file's colours mean if they are floats and the file does not say it": (
        "Was die Farben der Datei bedeuten, wenn sie Fließkommazahlen sind und die Datei es nicht sagt"
    ),
    "Display": "Anzeige",
    "Display values (sRGB), as in Blender's own PLY import": "Anzeigewerte (sRGB) wie in Blenders eigenem PLY-Import",
    "Linear": "Linear",
    "Scene-linear values": "Szenenlineare Werte",
    "Keep in a File": "In einer Datei behalten",
    (
        "Store the surfels in a file beside the .blend, from which every view reads only what it needs, instead of in "
        "the .blend. For more surfels or points than memory holds"
    ): (
        "Die Surfels in einer Datei neben der .blend-Datei speichern, aus der jede Ansicht nur liest, was sie braucht, "
        "statt in der .blend-Datei. Für mehr Surfels oder Punkte, als der Speicher fasst"
    ),
    "Converting to surfels: {percent:.0f}%   Esc cancels": "Umwandlung in Surfels: {percent:.0f}%   Esc bricht ab",
    "Counting …": "Wird gezählt …",
    "Device: {device}, {backend}": "Gerät: {device}, {backend}",
    "Drawn: {splats_drawn:,} of {splats:,} splats, and {polygons:,} polygons": (
        "Gezeichnet: {splats_drawn:,} von {splats:,} Splats und {polygons:,} Polygone"
    ),
    "Back-facing splats left out: {culled:,} ({percent:.0f}%)": (
        "Weggelassene abgewandte Splats: {culled:,} ({percent:.0f}%)"
    ),
    "No selected object is surfels; convert one first, or choose others": (
        "Kein ausgewähltes Objekt besteht aus Surfels; zuerst eines umwandeln oder andere auswählen"
    ),
    "No visible object holds surfels; convert one first": (
        "Kein sichtbares Objekt enthält Surfels; zuerst eines umwandeln"
    ),
    "No visible object is surfels; convert one first, or choose others": (
        "Kein sichtbares Objekt besteht aus Surfels; zuerst eines umwandeln oder andere auswählen"
    ),
    "Nothing has been rendered yet": "Noch wurde nichts gerendert",
    "Nothing to sample: no faces, or a density of 0": "Nichts abzutasten: keine Flächen oder eine Dichte von 0",
    "Objects are converted in object mode; leave the current mode first": (
        "Objekte werden im Objektmodus umgewandelt; zuerst den jetzigen Modus verlassen"
    ),
    "One warning: see Render Properties > Last Picture": "Eine Warnung: siehe Rendereigenschaften > Letztes Bild",
    "Points are converted in object mode; leave the current mode first": (
        "Punkte werden im Objektmodus umgewandelt; zuerst den jetzigen Modus verlassen"
    ),
    "Samples: {samples}": "Samples: {samples}",
    "Select a mesh object, curve, text, metaball or collection instance, not surfels already": (
        "Ein Mesh-Objekt, eine Kurve, einen Text, einen Metaball oder eine Collection-Instanz auswählen, "
        "die noch keine Surfels sind"
    ),
    "Select a point cloud, or a mesh that is not surfels already": (
        "Eine Punktwolke auswählen oder ein Mesh, das noch nicht aus Surfels besteht"
    ),
    "Skipped {count:,} unusable surfels": "{count:,} unbrauchbare Surfels ausgelassen",
    "The selected objects are surfels already; use Update to convert their sources again": (
        "Die ausgewählten Objekte sind schon Surfels; „Aktualisieren“ wandelt ihre Quellen erneut um"
    ),
    "The surfels of {names} are in files of their own; only the coarsest were written": (
        "Die Surfels von {names} liegen in eigenen Dateien; nur die gröbsten wurden geschrieben"
    ),
    "Textures on the device: {megabytes:,.1f} MB": "Texturen auf dem Gerät: {megabytes:,.1f} MB",
    "The conversion to surfels was cancelled; nothing was changed": (
        "Die Umwandlung in Surfels wurde abgebrochen; nichts wurde geändert"
    ),
    "The colours are out of date: {why}": "Die Farben sind veraltet: {why}",
    "Time: {milliseconds:,.0f} ms": "Zeit: {milliseconds:,.0f} ms",
    "{blur} needs more samples": "{blur} braucht mehr Samples",
    "{count:,} surfels of {objects} objects -> {path}": "{count:,} Surfels von {objects} Objekten -> {path}",
    "{count} warnings: see Render Properties > Last Picture": (
        "{count} Warnungen: siehe Rendereigenschaften > Letztes Bild"
    ),
    "{count}, fewer where flat": "{count}, weniger wo eben",
    "{name}: {count:,} surfels": "{name}: {count:,} Surfels",
    "{path} cannot be written: {why}": "{path} kann nicht geschrieben werden: {why}",
    "≈ {count:,} surfels, spacing {low} to {high}": "≈ {count:,} Surfels, Abstand {low} bis {high}",
    "≈ {count:,} surfels, spacing {spacing}": "≈ {count:,} Surfels, Abstand {spacing}",
    "A quarter of the surfels that the scene's camera needs, for a first look": (
        "Ein Viertel der Surfels, die die Kamera der Szene braucht, für einen ersten Blick"
    ),
    "Advanced": "Erweitert",
    "As many surfels as the scene's camera needs": "So viele Surfels, wie die Kamera der Szene braucht",
    "Brushes need faces, and surfels have none": "Pinsel brauchen Flächen, und Surfels haben keine",
    "Brushes need faces: paint {name}, or sculpt it and press Update": (
        "Pinsel brauchen Flächen: {name} bemalen, oder modellieren und „Aktualisieren“ drücken"
    ),
    (
        "Convert the sources of the selected surfels again, with the settings in the sidebar. It is also there "
        "while the source is edited, painted or sculpted"
    ): (
        "Die Quellen der ausgewählten Surfels noch einmal umwandeln, mit den Einstellungen in der Seitenleiste. "
        "Geht auch, während die Quelle bearbeitet, bemalt oder modelliert wird"
    ),
    "Draft": "Entwurf",
    "Error up to {worst} where detail is finer than a pixel": (
        "Fehler bis {worst}, wo Einzelheiten feiner als ein Pixel sind"
    ),
    (
        "How far surfels look from the mesh, as the mean perceived difference over what an object covers, and "
        "the density that this takes. Larger models are closer than it says"
    ): (
        "Wie sehr Surfels anders aussehen als das Mesh, als mittlerer wahrgenommener Unterschied über das, was "
        "ein Objekt bedeckt, und die Dichte, die das braucht. Größere Modelle sind "
        "näher, als sie sagt"
    ),
    "Edges": "Kanten",
    "Files": "Dateien",
    "Fine": "Fein",
    "Four times as many, for fine textures and for coming closer later": (
        "Viermal so viele, für feine Texturen und um später näher zu kommen"
    ),
    "Hide the surfels and show the object that they were made from": (
        "Die Surfels ausblenden und das Objekt zeigen, aus dem sie gemacht wurden"
    ),
    "Hides Its Sources": "Blendet Quellen aus",
    "How many surfels there are; under Advanced is a density for everything else": (
        "Wie viele Surfels es sind; unter „Erweitert“ steht eine Dichte für alles andere"
    ),
    "Meshes need no conversion: choose the engine and press F12": (
        "Meshes brauchen keine Umwandlung: die Engine wählen und F12 drücken"
    ),
    "No surfels of {name} yet": "Noch keine Surfels von {name}",
    "Other": "Andere",
    "Quality": "Qualität",
    "Select a mesh or a scan": "Ein Mesh oder einen Scan auswählen",
    "Select surfels or what they were made from, in Object Mode": (
        "Im Objektmodus Surfels auswählen oder woraus sie gemacht wurden"
    ),
    "Select surfels that were converted from an object of this file, or that object": (
        "Surfels auswählen, die aus einem Objekt dieser Datei umgewandelt wurden, oder dieses Objekt"
    ),
    "Show": "Zeigen",
    "Show Surfels or Source": "Surfels oder Quelle zeigen",
    "Show the surfels in place of the object that they were made from": (
        "Die Surfels anstelle des Objekts zeigen, aus dem sie gemacht wurden"
    ),
    ("Show the surfels in place of their source, or the source in place of its surfels, in views and in renders"): (
        "In Ansichten und Renderings die Surfels anstelle ihrer Quelle zeigen, oder die Quelle anstelle ihrer Surfels"
    ),
    "Surfels in a file: {name}": "Surfels in einer Datei: {name}",
    "The density chosen under Advanced": "Die Dichte, die unter „Erweitert“ gewählt ist",
    "The sources were hidden by the conversion, and are again when its surfels are shown": (
        "Die Quellen wurden bei der Umwandlung ausgeblendet, und werden es wieder, wenn ihre Surfels gezeigt werden"
    ),
    "Update": "Aktualisieren",
    (
        "Use larger surfels inside faces that are flat and look the same everywhere, as those of buildings and machines"
    ): (
        "Größere Surfels innerhalb von Flächen verwenden, die eben sind und überall gleich aussehen, wie die von "
        "Gebäuden und Maschinen"
    ),
    "What is seen in views and in renders": "Was in Ansichten und Renderings zu sehen ist",
    "{count:,} points in {name}": "{count:,} Punkte in {name}",
    "{count:,} surfels of {name}": "{count:,} Surfels von {name}",
    "Blend Precision": "Genauigkeit der Mischung",
    "Render": "Rendern",
    "Shadow Resolution": "Auflösung der Schatten",
    "Shutter Steps": "Schritte des Verschlusses",
    "Simplify": "Vereinfachen",
    "Matrix of the surfels in the space of the first source, when converted": (
        "Matrix der Surfels im Raum der ersten Quelle, als sie umgewandelt wurden"
    ),
    "Place": "Ort",
    "Added to the number of a file to give the frame at which it is shown": (
        "Wird zur Nummer einer Datei addiert und ergibt das Einzelbild, in dem sie gezeigt wird"
    ),
    "Frame Offset": "Einzelbildversatz",
    "Numbered Series": "Nummerierte Serie",
    (
        "Show each of the files whose names differ in their last number at the frame of its number, such as "
        "those of a scan that moves. A file is read when its frame is shown"
    ): (
        "Jede der Dateien, deren Namen sich in der letzten Nummer unterscheiden, im Einzelbild ihrer Nummer "
        "zeigen, etwa die eines bewegten Scans. Eine Datei wird gelesen, wenn ihr Einzelbild gezeigt wird"
    ),
    "One of several numbered files, each of which is shown at the frame of its number": (
        "Eine von mehreren nummerierten Dateien, von denen jede im Einzelbild ihrer Nummer gezeigt wird"
    ),
    "Series": "Serie",
    "What the files' colours mean if they are floats and the files do not say it": (
        "Was die Farben der Dateien bedeuten, wenn sie Gleitkommazahlen sind und die Dateien es nicht sagen"
    ),
    (
        "The name has no number that counts the files of a series; import it without Numbered Series"
    ): "Der Name hat keine Nummer, die die Dateien einer Serie zählt; ohne Nummerierte Serie importieren",
    "Took {count:,} files as a series, for the frames {first:,} to {last:,}": (
        "{count:,} Dateien als Serie genommen, für die Einzelbilder {first:,} bis {last:,}"
    ),
    "The files of a series are shown from memory; they cannot be files of blocks": (
        "Die Dateien einer Serie werden aus dem Speicher gezeigt; es können keine Dateien aus Blöcken sein"
    ),
    (
        "Add a camera that goes where the scanner went during the scene's frames: from place to place, or "
        "along the flight. At a single place it turns around once"
    ): (
        "Eine Kamera hinzufügen, die während der Einzelbilder der Szene den Weg des Scanners nimmt: von Ort "
        "zu Ort oder entlang des Fluges. An einem einzigen Ort dreht sie sich einmal um sich selbst"
    ),
    "Camera from Scanner": "Kamera vom Scanner",
    "Where the camera looks": "Wohin die Kamera blickt",
    "At the scan from a flight, and ahead from places on the ground": (
        "Von einem Flug aus auf den Scan, von Orten am Boden aus nach vorn"
    ),
    "Ahead": "Voraus",
    "Where it goes, level": "Wohin sie sich bewegt, waagrecht",
    "At the Scan": "Auf den Scan",
    "At the middle of the surfels": "Auf die Mitte der Surfel",
    "Select the surfels of a scan whose file tells where the scanner was": (
        "Die Surfel eines Scans auswählen, dessen Datei sagt, wo der Scanner war"
    ),
    "{count:,} places of the scanner, from frame {first} to {last}": (
        "{count:,} Orte des Scanners, von Einzelbild {first} bis {last}"
    ),
    "Look": "Blick",
    "At Most": "Höchstens",
    (
        "Take so many points of a scan that has more, evenly; 0 takes all. Of LAS and COPC the rest is not "
        "read; LAZ is read at some millions of points a second"
    ): (
        "So viele Punkte eines Scans nehmen, der mehr hat, gleichmäßig verteilt; 0 nimmt alle. Von LAS und "
        "COPC wird der Rest nicht gelesen; LAZ wird mit einigen Millionen Punkten je Sekunde gelesen"
    ),
    "A file of blocks takes all points; set At Most to 0": (
        "Eine Datei aus Blöcken nimmt alle Punkte; Höchstens auf 0 setzen"
    ),
    "Points to take of a file that has more, evenly; 0 takes all": (
        "Punkte, die von einer Datei mit mehr genommen werden, gleichmäßig verteilt; 0 nimmt alle"
    ),
    "Columns": "Spalten",
    (
        "What the columns of a text file are, with blanks between: x y z, red green blue, nx ny nz, "
        "intensity; and - for one to leave out. Empty takes what the file says, or a guess"
    ): (
        "Was die Spalten einer Textdatei sind, mit Leerzeichen dazwischen: x y z, red green blue, nx ny nz, "
        "intensity; und - für eine, die weggelassen wird. Leer nimmt, was die Datei sagt, oder eine Vermutung"
    ),
    "What the columns of text files are, with blanks between": (
        "Was die Spalten von Textdateien sind, mit Leerzeichen dazwischen"
    ),
}
