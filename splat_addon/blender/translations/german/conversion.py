# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes to surfels: the sidebar, and what a conversion does, asks and says."""

TEXTS = {
    "A crease is where the surface or its shading turns by more than this angle. Beside faces that are "
    "larger than a surfel a smaller angle is enough, down to a sixth of this one": (
        "Eine Falte ist, wo sich die Fläche oder ihre Schattierung um mehr als diesen Winkel dreht. Neben Flächen, "
        "die größer als ein Surfel sind, genügt ein kleinerer Winkel, bis zu einem Sechstel von diesem"
    ),
    "A quarter of the surfels that the scene's camera needs, for a first look": (
        "Ein Viertel der Surfels, die die Kamera der Szene braucht, für einen ersten Blick"
    ),
    "Adaptive": "Adaptiv",
    "Add a preset of the conversion settings in the sidebar, or remove one": (
        "Eine Voreinstellung der Umwandlungseinstellungen in der Seitenleiste hinzufügen oder eine entfernen"
    ),
    "Add Surfel Conversion Preset": "Umwandlungsvoreinstellung hinzufügen",
    "Advanced": "Erweitert",
    "Approximate number of surfels for each object": ("Ungefähre Anzahl von Surfels für jedes Objekt"),
    "As many surfels as the scene's camera needs": "So viele Surfels, wie die Kamera der Szene braucht",
    "Bake Materials": "Materialien backen",
    "Brushes need faces, and surfels have none": "Pinsel brauchen Flächen, und Surfels haben keine",
    "Brushes need faces: paint {name}, or sculpt it and press Update": (
        "Pinsel brauchen Flächen: {name} bemalen, oder modellieren und „Aktualisieren“ drücken"
    ),
    "Choose the render engine {engine} to see the surfels": (
        "Die Render-Engine {engine} wählen, um die Surfels zu sehen"
    ),
    (
        "Convert the selected objects, with their modifiers, to surfel objects in exactly the same place. It "
        "converts meshes, curves, texts, metaballs, and the instances of Geometry Nodes and collections"
    ): (
        "Die ausgewählten Objekte mit ihren Modifikatoren in Surfelobjekte an genau derselben Stelle umwandeln: "
        "Meshes, Kurven, Texte, Metabälle und die Instanzen von Geometry Nodes und Sammlungen"
    ),
    (
        "Convert the sources of the selected surfels again, with the settings in the sidebar. It is also there "
        "while the source is edited, painted or sculpted"
    ): (
        "Die Quellen der ausgewählten Surfels noch einmal umwandeln, mit den Einstellungen in der Seitenleiste. "
        "Geht auch, während die Quelle bearbeitet, bemalt oder modelliert wird"
    ),
    "Convert to Surfels": "In Surfels umwandeln",
    ("Diffuse light and a highlight as sharp as the material is smooth; lights are points (Blinn 1977, normalised)"): (
        "Diffuses Licht und ein Glanzlicht, so scharf, wie das Material glatt ist; Lampen sind Punkte (Blinn "
        "1977, normiert)"
    ),
    "Disabled in Renders Before": "Zuvor vom Rendern ausgeschlossen",
    "Draft": "Entwurf",
    (
        "Drop samples where the normal of the surface is more than this angle away from the axis of sampling. "
        "90 degrees keeps all samples"
    ): (
        "Proben weglassen, wo die Normale der Fläche um mehr als diesen Winkel von der Achse der Abtastung abweicht. "
        "90 Grad behält alle Proben"
    ),
    "Edges": "Kanten",
    "End at Edges": "An Kanten enden",
    (
        "End surfels at creases, at borders between colours and at open borders, and make their blend depth no "
        "larger than their surface needs. Edges stay sharp, but conversion takes longer, and frames take slightly "
        "longer"
    ): (
        "Surfels an Falten, Farbgrenzen und offenen Rändern enden lassen und ihre Mischtiefe nicht größer "
        "machen, als ihre Fläche braucht. Kanten bleiben scharf, aber die Umwandlung dauert länger und Einzelbilder "
        "etwas länger"
    ),
    "Error up to {worst} where detail is finer than a pixel": (
        "Fehler bis {worst}, wo Einzelheiten feiner als ein Pixel sind"
    ),
    "Files": "Dateien",
    "Fine": "Fein",
    "Follow Source": "Quelle folgen",
    "Four times as many, for fine textures and for coming closer later": (
        "Viermal so viele, für feine Texturen und um später näher zu kommen"
    ),
    "Grazing Angle": "Streifwinkel",
    (
        "Half-axis of a splat, in spacings. 1.25 covers every surface; smaller splats are sharper but leave dark "
        "specks. The papers' surfel quads have 0.5"
    ): (
        "Halbachse eines Splats, in Abständen. 1,25 bedeckt jede Fläche; kleinere Splats sind schärfer, "
        "lassen aber dunkle Punkte. Die gedruckten Quadrate haben 0,5"
    ),
    "Hidden for Surfels": "Für Surfels versteckt",
    "Hide the object in the viewport and in renders, so that only its surfels are seen": (
        "Das Objekt im Ansichtsfenster und beim Rendern verstecken, sodass nur seine Surfels zu sehen sind"
    ),
    "Hide the surfels and show the object that they were made from": (
        "Die Surfels ausblenden und das Objekt zeigen, aus dem sie gemacht wurden"
    ),
    "Hides Its Sources": "Blendet Quellen aus",
    (
        "How far a larger surfel may be from the surface that it covers, in the units of the chosen space. Above 0,"
        " surfels also become larger across nearly flat faces, but conversion takes longer"
    ): (
        "Wie weit ein größeres Surfel von der Fläche entfernt sein darf, die es bedeckt, in den Einheiten des "
        "gewählten Raums. Über 0 werden Surfels auch über beinahe ebene Flächen hinweg größer, aber die Umwandlung "
        "dauert länger"
    ),
    (
        "How far surfels look from the mesh, as the mean perceived difference over what an object covers, and "
        "the density that this takes. Larger models are closer than it says"
    ): (
        "Wie sehr Surfels anders aussehen als das Mesh, als mittlerer wahrgenommener Unterschied über das, was "
        "ein Objekt bedeckt, und die Dichte, die das braucht. Größere Modelle sind "
        "näher, als sie sagt"
    ),
    "How many surfels there are; under Advanced is a density for everything else": (
        "Wie viele Surfels es sind; unter „Erweitert“ steht eine Dichte für alles andere"
    ),
    "How the distance between surfels is chosen": "Wie der Abstand zwischen den Surfels gewählt wird",
    "Join": "Zusammenführen",
    "Kind": "Art",
    "Leave the object as it is, in the same place as its surfels": (
        "Das Objekt lassen, wie es ist, an derselben Stelle wie seine Surfels"
    ),
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
        "Let the surfels follow their source, with its parent, animation and constraints. If off, they are a "
        "frozen copy"
    ): (
        "Die Surfels ihrer Quelle folgen lassen, mit deren Übergeordnetem, Animation und Einschränkungen. "
        "Sonst sind sie eine eingefrorene Kopie"
    ),
    (
        "Make one surfel object of the whole selection, in the place of the active object. The density then "
        "refers to the whole"
    ): (
        "Aus der ganzen Auswahl ein einziges Surfelobjekt an der Stelle des aktiven Objekts machen. Die "
        "Dichte bezieht sich dann auf das Ganze"
    ),
    "Material inputs that could not be read, one per line": (
        "Materialeingänge, die nicht gelesen werden konnten, einer pro Zeile"
    ),
    "Matrix of the surfels in the space of the first source, when converted": (
        "Matrix der Surfels im Raum der ersten Quelle, als sie umgewandelt wurden"
    ),
    "No surfels of {name} yet": "Noch keine Surfels von {name}",
    "Not Sampled": "Nicht abgetastet",
    "Objects are converted in object mode; leave the current mode first": (
        "Objekte werden im Objektmodus umgewandelt; zuerst den jetzigen Modus verlassen"
    ),
    "Offset of the coordinates: {offset}": "Versatz der Koordinaten: {offset}",
    "Origin": "Ursprung",
    "Origin of the surfels, in the space of the first source": "Ursprung der Surfels, im Raum der ersten Quelle",
    "Other": "Andere",
    "Place": "Ort",
    "Quality": "Qualität",
    "Reduction": "Reduktion",
    "Select a mesh object, curve, text, metaball or collection instance, not surfels already": (
        "Ein Mesh-Objekt, eine Kurve, einen Text, einen Metaball oder eine Collection-Instanz auswählen, "
        "die noch keine Surfels sind"
    ),
    "Select a mesh or a scan": "Ein Mesh oder einen Scan auswählen",
    "Select surfels or what they were made from, in Object Mode": (
        "Im Objektmodus Surfels auswählen oder woraus sie gemacht wurden"
    ),
    "Select surfels that were converted from an object of this file, or that object": (
        "Surfels auswählen, die aus einem Objekt dieser Datei umgewandelt wurden, oder dieses Objekt"
    ),
    "Shape": "Form",
    "Show": "Zeigen",
    "Show Surfels or Source": "Surfels oder Quelle zeigen",
    "Show the surfels in place of the object that they were made from": (
        "Die Surfels anstelle des Objekts zeigen, aus dem sie gemacht wurden"
    ),
    ("Show the surfels in place of their source, or the source in place of its surfels, in views and in renders"): (
        "In Ansichten und Renderings die Surfels anstelle ihrer Quelle zeigen, oder die Quelle anstelle ihrer Surfels"
    ),
    "Space": "Raum",
    "Storing surfels: {percent:.0f}%   Esc cancels": "Surfels werden gespeichert: {percent:.0f}%   Esc bricht ab",
    "Storing was cancelled; nothing was changed": "Das Speichern wurde abgebrochen; nichts wurde geändert",
    "Surfel Conversion Presets": "Umwandlungsvoreinstellungen",
    "Surfels in a file: {name}": "Surfels in einer Datei: {name}",
    "Switch to Surfel Splatting as the render engine, and to Rendered shading in this 3D view": (
        "Zu Surfel Splatting als Render-Engine und in dieser 3D-Ansicht zur Schattierung Gerendert wechseln"
    ),
    "The colours are out of date: {why}": "Die Farben sind veraltet: {why}",
    "The conversion to surfels was cancelled; nothing was changed": (
        "Die Umwandlung in Surfels wurde abgebrochen; nichts wurde geändert"
    ),
    "The density chosen under Advanced": "Die Dichte, die unter „Erweitert“ gewählt ist",
    "The object's own space, so that its scale also scales the spacing": (
        "Der Raum des Objekts selbst, dessen Skalierung dann auch den Abstand skaliert"
    ),
    "The selected objects are surfels already; use Update to convert their sources again": (
        "Die ausgewählten Objekte sind schon Surfels; „Aktualisieren“ wandelt ihre Quellen erneut um"
    ),
    "The sources were hidden by the conversion, and are again when its surfels are shown": (
        "Die Quellen wurden bei der Umwandlung ausgeblendet, und werden es wieder, wenn ihre Surfels gezeigt werden"
    ),
    "The space in which surfels are spaced evenly and lengths are measured": (
        "Der Raum, in dem Surfels gleichmäßig verteilt und Längen gemessen werden"
    ),
    "The surface is sampled along three axes; this chooses which of these samples become surfels": (
        "Die Fläche wird entlang von drei Achsen abgetastet; dies wählt, welche dieser Proben zu Surfels werden"
    ),
    "Their points were taken": "Ihre Punkte wurden übernommen",
    "Their surfaces were sampled": "Ihre Flächen wurden abgetastet",
    "This object was already disabled in renders when it was converted, and stays so": (
        "Dieses Objekt war bei der Umwandlung schon vom Rendern ausgeschlossen und bleibt es"
    ),
    "This object was hidden when it was converted, and comes back when its surfels are deleted": (
        "Dieses Objekt wurde bei der Umwandlung versteckt und kommt wieder, wenn seine Surfels gelöscht werden"
    ),
    "Tolerance": "Toleranz",
    "Update": "Aktualisieren",
    "Update Surfels from Source": "Surfels aus Quelle aktualisieren",
    (
        "Use larger surfels inside faces that are flat and look the same everywhere, as those of buildings and machines"
    ): (
        "Größere Surfels innerhalb von Flächen verwenden, die eben sind und überall gleich aussehen, wie die von "
        "Gebäuden und Maschinen"
    ),
    "What happens to the object that was converted": "Was mit dem Objekt geschieht, das umgewandelt wurde",
    "What is seen in views and in renders": "Was in Ansichten und Renderings zu sehen ist",
    "What it was made of when it was converted, as checksums": (
        "Woraus es bestand, als es umgewandelt wurde, als Prüfsummen"
    ),
    "Whether surfaces or points of the sources were converted": "Ob Flächen oder Punkte der Quellen umgewandelt wurden",
    "World space, so that scaled objects are as dense as others; the surfel object has a scale of 1": (
        "Weltraum, in dem skalierte Objekte so dicht sind wie andere; das Surfelobjekt hat die Skalierung 1"
    ),
    "{count:,} points in {name}": "{count:,} Punkte in {name}",
    "{count:,} surfels of {name}": "{count:,} Surfels von {name}",
}
