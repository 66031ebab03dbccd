# SPDX-License-Identifier: GPL-3.0-or-later
"""German, in the words that Blender's own German interface uses."""

from __future__ import annotations

GERMAN = {
    "16 Bit": "16 Bit",
    "24 bytes a sample, at least 62 dB from Float 32 with 300 splats over a pixel, and wrong from 1,000": (
        "24 Byte pro Sample, mindestens 62 dB von Float 32 bei 300 Splats über einem Pixel, und falsch ab 1.000"
    ),
    "3-to-1": "3 zu 1",
    "32 bytes a sample, exact with thousands of splats over a pixel": (
        "32 Byte pro Sample, genau bei Tausenden von Splats über einem Pixel"
    ),
    "32 bytes a surfel, at least 58 dB from Float 32": "32 Byte pro Surfel, mindestens 58 dB von Float 32",
    "3D Cursor": "3D-Cursor",
    "64 bytes a surfel, exact": "64 Byte pro Surfel, genau",
    (
        "A crease is drawn where the surface turns by more than this angle within about 3 pixels; 180 "
        "degrees draws none"
    ): (
        "Eine Falte wird gezeichnet, wo sich die Fläche innerhalb von etwa 3 Pixeln um mehr als diesen Winkel "
        "dreht; 180 Grad zeichnet keine"
    ),
    "A number of cells along each object's longest edge": (
        "Eine Anzahl von Zellen entlang der längsten Kante jedes Objekts"
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
    "An image of a lit ball that fills the frame. Of a multilayer file the first layer is shown": (
        "Ein Bild einer beleuchteten Kugel, die das Bild ausfüllt. Von einer mehrschichtigen Datei wird die "
        "erste Schicht gezeigt"
    ),
    "Angle": "Winkel",
    "As Render Meshes as in the render properties says": ("So, wie es Meshes als in den Rendereigenschaften sagt"),
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
    "As the Scene Says": "Wie die Szene sagt",
    "Automatic": "Automatisch",
    "Away from the middle of each connected part, for scans of whole objects": (
        "Weg von der Mitte jedes zusammenhängenden Teils, für Scans ganzer Objekte"
    ),
    "Bake Materials": "Materialien backen",
    "Balanced": "Ausgewogen",
    "Beam Shape": "Strahlform",
    "Blend": "Mischung",
    "Blend Depth": "Mischtiefe",
    "Blend the Rest": "Rest mischen",
    "Blur Samples": "Unschärfe-Samples",
    "Blur at Least": "Unschärfe ab",
    "Broken Objects": "Fehlerhafte Objekte",
    "Camera": "Kamera",
    "Choose method and samples together": "Methode und Samples zusammen wählen",
    "Choose the render engine that draws surfels, and Rendered shading in this 3D view": (
        "Die Render-Engine wählen, die Surfels zeichnet, und in dieser 3D-Ansicht die Schattierung Gerendert"
    ),
    "Color": "Farbe",
    "Conversion in New Scenes": "Umwandlung in neuen Szenen",
    "Convert Points to Surfels": "Punkte in Surfels umwandeln",
    "Convert the sources of the selected surfels again, as they are now, with the settings of the first time": (
        "Die Quellen der ausgewählten Surfels so, wie sie jetzt sind, noch einmal umwandeln, mit den "
        "Einstellungen vom ersten Mal"
    ),
    "Convert to Surfels": "In Surfels umwandeln",
    "Count": "Anzahl",
    "Coverage": "Bedeckung",
    "Crease Angle": "Faltenwinkel",
    "Cryptomatte": "Cryptomatte",
    "Density": "Dichte",
    "Depth": "Tiefe",
    "Depth Threshold": "Tiefenschwelle",
    "Detail Tolerance": "Detailtoleranz",
    (
        "Diffuse and GGX specular light of the scene's lights and world (Walter et al. 2007, Heitz et al. "
        "2016). 1.11 times the frame of Flat"
    ): (
        "Diffuses und glänzendes (GGX-)Licht der Lampen und der Welt (Walter et al. 2007, Heitz et al. "
        "2016). 1,11-mal das Einzelbild von Flach"
    ),
    (
        "Diffuse light and a highlight as sharp as the material is smooth; lights are points (Blinn 1977, "
        "normalised). 1.06 times the frame of Flat"
    ): (
        "Diffuses Licht und ein Glanzlicht, so scharf, wie das Material glatt ist; Lampen sind Punkte (Blinn "
        "1977, normiert). 1,06-mal das Einzelbild von Flach"
    ),
    (
        "Discs in point sprites of which the nearest is seen: nothing blends, 0.65 to 0.7 of the time of "
        "Quads (Botsch and Kobbelt 2003, sections 3.1 and 3.2)"
    ): (
        "Scheiben in Punktsprites, von denen die nächste zu sehen ist: Nichts mischt sich, 0,65 bis 0,7 der "
        "Zeit von Quads (Botsch und Kobbelt 2003, Abschnitte 3.1 und 3.2)"
    ),
    "Discs in point sprites; opens holes at flat angles (Botsch and Kobbelt 2003, sections 3.1 to 3.4)": (
        "Scheiben in Punktsprites; öffnet bei flachen Winkeln Löcher (Botsch und Kobbelt 2003, Abschnitte 3.1 bis 3.4)"
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
        "Draw larger surfels in place of those that are too small to be seen, off by at most this many "
        "pixels. 0 draws every surfel; 1.25 makes large sets many times faster"
    ): (
        "Größere Surfels anstelle von solchen zeichnen, die zu klein sind, um gesehen zu werden, mit "
        "höchstens so vielen Pixeln Abweichung. 0 zeichnet jedes Surfel; 1,25 macht große Mengen "
        "um ein Vielfaches schneller"
    ),
    ("Draw lines along silhouettes and creases, with any shading. It takes 1.5 to 1.7 times the time of a frame"): (
        "Linien entlang von Umrissen und Falten zeichnen, bei jeder Schattierung. Das braucht die 1,5- bis "
        "1,7-fache Zeit eines Einzelbilds"
    ),
    (
        "Draw polygons up to a distance from the camera and surfels beyond it. It takes 1.4 times the time "
        "of surfels alone"
    ): (
        "Bis zu einer Entfernung von der Kamera Polygone und dahinter Surfels zeichnen. Das braucht 1,4-mal "
        "so lange wie Surfels allein"
    ),
    "Draw polygons where the weights of a vertex group are 0.5 or more, and surfels elsewhere": (
        "Polygone zeichnen, wo die Gewichte einer Vertexgruppe 0,5 oder mehr sind, und anderswo Surfels"
    ),
    (
        "Draw the triangles among the splats, with the same depth, light and shadows. Transparent meshes "
        "become surfels unless their object says otherwise"
    ): (
        "Die Dreiecke zwischen den Splats zeichnen, mit derselben Tiefe, demselben Licht und denselben "
        "Schatten. Transparente Meshes werden zu Surfels, wenn ihr Objekt nichts anderes sagt"
    ),
    "Drawn by Cycles only; choose another": "Nur von Cycles gezeichnet; anderes wählen",
    "Drop": "Entfernen",
    "EWA": "EWA",
    "EWA in Space": "EWA im Raum",
    (
        "Each light in a few even steps, with a highlight that has an edge (Lake et al. 2000). 1.06 times "
        "the frame of Flat"
    ): (
        "Jede Lampe in wenigen gleichmäßigen Stufen, mit einem scharf begrenzten Glanzlicht (Lake et al. "
        "2000). 1,06-mal das Einzelbild von Flach"
    ),
    "Edge Fade": "Randverlauf",
    "End at Edges": "An Kanten enden",
    "Environment": "Umgebung",
    (
        "Exact ellipses no smaller than the pixel's filter, at their planes' depth; 3 dB truer at flat "
        "angles (Guennebaud et al. 2006, sections 3 and 4, repaired)"
    ): (
        "Genaue Ellipsen, nicht kleiner als der Filter des Pixels, in der Tiefe ihrer Ebenen; bei flachen "
        "Winkeln 3 dB genauer (Guennebaud et al. 2006, Abschnitte 3 und 4, berichtigt)"
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
        "Filtered, so smooth and still in animations and fine textures: 40 to 47 dB and FLIP 0.007 to 0.016 "
        "from filtered pixels, in about 1.6 times the time of Preview a sample. 16 samples smooth creases "
        "and polygons"
    ): (
        "Gefiltert, daher glatt und ruhig in Animationen und feinen Texturen: 40 bis 47 dB und FLIP 0,007 "
        "bis 0,016 von gefilterten Pixeln, in etwa der 1,6-fachen Zeit der Vorschau pro Sample. 16 Samples "
        "glätten Falten und Polygone"
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
    "From Meshes": "Aus Meshes",
    "From Points and Files": "Aus Punkten und Dateien",
    "Gaussian Splats": "Gaussian Splats",
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
        "Half-axis of a splat, in spacings. 1.25 covers every surface; smaller splats are sharper but leave dark specks"
    ): (
        "Halbachse eines Splats, in Abständen. 1,25 bedeckt jede Fläche; kleinere Splats sind schärfer, "
        "lassen aber dunkle Punkte"
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
    "How a splat is drawn and filtered": "Wie ein Splat gezeichnet und gefiltert wird",
    "How far away a surface can be and still block the world's light": (
        "Wie weit entfernt eine Fläche sein und das Licht der Welt noch abhalten kann"
    ),
    (
        "How far behind the nearest splat others still blend with it, in splat radii. Lower values separate "
        "thin sheets; below 0.2 the surface breaks up"
    ): (
        "Wie weit hinter dem nächsten Splat andere sich noch mit ihm mischen, in Splatradien. Kleinere Werte "
        "trennen dünne Schichten; unter 0,2 bricht die Fläche auf"
    ),
    "How far the surface may be from flat where surfels become larger, in the units of the chosen space": (
        "Wie weit die Fläche von einer Ebene abweichen darf, wo Surfels größer werden, in den Einheiten des "
        "gewählten Raums"
    ),
    (
        "How many splats a sample is the mean of: 1 blue, 4 cyan, 16 green, 64 yellow, 256 and more red "
        "(none needed). 1.04 times the frame of Flat"
    ): (
        "Aus wie vielen Splats ein Sample gemittelt ist: 1 blau, 4 türkis, 16 grün, 64 gelb, 256 und mehr "
        "rot (keine Quelle nötig). 1,04-mal das Einzelbild von Flach"
    ),
    "How many splats each pixel's samples average. It takes 1.03 times the time of a frame": (
        "Wie viele Splats die Samples jedes Pixels mitteln. Das braucht die 1,03-fache Zeit eines Einzelbilds"
    ),
    "How many surfels each object becomes, within 1 %": ("Wie viele Surfels aus jedem Objekt werden, auf 1 % genau"),
    (
        "How many times closer together the surfels of this object lie than the density says. 2 makes four "
        "times as many surfels"
    ): ("Wievielmal dichter die Surfels dieses Objekts liegen, als die Dichte sagt. 2 ergibt viermal so viele Surfels"),
    "How meshes, curves, texts and metaballs are drawn that have not been converted": (
        "Wie nicht umgewandelte Meshes, Kurven, Texte und Metabälle gezeichnet werden"
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
    ("How thick a Gaussian may be, in its middle radius, to become a surfel; thicker ones are left out. 1 takes all"): (
        "Wie dick eine Gaußverteilung sein darf, in ihrem mittleren Radius, um ein Surfel zu werden; dickere "
        "werden weggelassen. 1 nimmt alle"
    ),
    (
        "How this object and its instances are drawn. Conversion sets it to Nothing, because the surfels "
        "stand in the object's place"
    ): (
        "Wie dieses Objekt und seine Instanzen gezeichnet werden. Die Umwandlung setzt es auf Nichts, weil "
        "die Surfels an der Stelle des Objekts stehen"
    ),
    "Import": "Importieren",
    "Import Surfels": "Surfels importieren",
    "Include": "Einschließen",
    "Its Emission node's colour and strength scale the light": (
        "Farbe und Stärke der Emission-Node skalieren das Licht"
    ),
    "Its first layer, without Specular Highlights": "Die erste Schicht, ohne Glanzlichter",
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
    "Leave the points as they are: of a mesh, as black dots over the surfels": (
        "Die Punkte lassen, wie sie sind: die eines Meshes als schwarze Punkte über den Surfels"
    ),
    "Leave them out": "Weglassen",
    "Leave them out, since most are errors of the scanner": ("Weglassen, denn die meisten sind Fehler des Scanners"),
    (
        "Let Cycles bake material inputs that cannot be read directly, such as procedural textures. It adds "
        "about 35 s for a million surfels and each such input"
    ): (
        "Cycles Materialeingänge backen lassen, die nicht direkt gelesen werden können, etwa prozedurale "
        "Texturen. Das kostet etwa 35 s für eine Million Surfels und jeden solchen Eingang"
    ),
    "Let Cycles bake what the materials could not be read for. 35 s for a million surfels and input": (
        "Cycles backen lassen, wofür die Materialien nicht gelesen werden konnten. 35 s für eine Million "
        "Surfels und jeden Eingang"
    ),
    ("Let visible surfaces block the world's light from one another. It takes 1.1 to 1.5 times the time of a frame"): (
        "Sichtbare Flächen das Licht der Welt voneinander abhalten lassen. Das braucht die 1,1- bis "
        "1,5-fache Zeit eines Einzelbilds"
    ),
    "Levels": "Stufen",
    "Levels of brightness that each light is shown in": "Helligkeitsstufen, in denen jede Lampe gezeigt wird",
    "Light": "Licht",
    "Lines": "Linien",
    (
        "Look the base colour's image up at every pixel instead of once a surfel. Textures are much sharper, "
        "and a frame takes 3.6 to 6 times as long in software"
    ): (
        "Das Bild der Grundfarbe an jedem Pixel nachschlagen statt einmal pro Surfel. Texturen werden viel "
        "schärfer, und ein Einzelbild braucht in Software 3,6- bis 6-mal so lange"
    ),
    (
        "Make a surfel of every point of the selected point clouds and meshes; what they lack, normals, "
        "sizes and directions, is estimated from neighbouring points"
    ): (
        "Aus jedem Punkt der ausgewählten Punktwolken und Meshes ein Surfel machen; was fehlt, Normalen, "
        "Größen und Richtungen, wird aus benachbarten Punkten geschätzt"
    ),
    (
        "Make one surfel object of everything that is selected, in the place of the active object. Density "
        "then refers to the whole"
    ): (
        "Aus der ganzen Auswahl ein einziges Surfelobjekt an der Stelle des aktiven Objekts machen. Die "
        "Dichte bezieht sich dann auf das Ganze"
    ),
    "Matcap": "Matcap",
    "Measure how long each pass takes, by waiting for the graphics device after each": (
        "Messen, wie lange jeder Durchgang braucht, indem nach jedem auf das Grafikgerät gewartet wird"
    ),
    (
        "Megabytes that a final render, and each 3D view, may take of the graphics device. A picture that "
        "needs more stops and says so. 0 sets no limit"
    ): (
        "Megabyte, die ein endgültiges Rendern und jede 3D-Ansicht auf dem Grafikgerät belegen dürfen. Ein "
        "Bild, das mehr braucht, bricht ab und sagt es. 0 setzt keine Grenze"
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
        "Moments of the open shutter at which the scene is evaluated. Fewer are faster, and show what moves "
        "as separate pictures"
    ): (
        "Zeitpunkte des offenen Verschlusses, an denen die Szene ausgewertet wird. Weniger sind schneller "
        "und zeigen, was sich bewegt, als einzelne Bilder"
    ),
    "Motion Blur": "Bewegungsunschärfe",
    "Neighbours": "Nachbarn",
    (
        "No filter: the fastest, and with many samples the sharpest (View-independent object-space surface "
        "splatting, sections 4.1 to 4.3)"
    ): (
        "Kein Filter: am schnellsten und mit vielen Samples am schärfsten (View-independent object-space "
        "surface splatting, Abschnitte 4.1 bis 4.3)"
    ),
    "Nodes": "Nodes",
    "None": "Keine",
    "Normal": "Normale",
    "Normals": "Normalen",
    "Normals Face": "Normalen nach",
    "Not Sampled": "Nicht abgetastet",
    "Nothing": "Nichts",
    (
        "Number of neighbours from which a point's normal and size are estimated. More smooth out noise; "
        "fewer keep small details"
    ): (
        "Anzahl der Nachbarn, aus denen Normale und Größe eines Punkts geschätzt werden. Mehr glätten "
        "Rauschen; weniger erhalten kleine Details"
    ),
    (
        "Number of pictures that a final render averages, each through another place in the pixel, on the "
        "lens and in time. Each takes the time of one picture"
    ): (
        "Anzahl der Bilder, über die ein endgültiges Rendern mittelt, jedes durch eine andere Stelle im "
        "Pixel, in der Linse und in der Zeit. Jedes braucht die Zeit eines Bilds"
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
    "Of the lines": "Der Linien",
    "Of the surfels, in the space of the first source": "Der Surfels, im Raum der ersten Quelle",
    "Origin": "Ursprung",
    "Outward": "Nach außen",
    "Overdraw": "Überzeichnung",
    "Override": "Überschreiben",
    "Panorama": "Panorama",
    "Passes": "Durchgänge",
    "Performance": "Leistung",
    "Persistent Data": "Beständige Daten",
    "Phong": "Phong",
    "Pixels per Surfel": "Pixel pro Surfel",
    "Plan": "Plan",
    "Points": "Punkte",
    "Polygons": "Polygone",
    "Position": "Position",
    "Preset": "Voreinstellung",
    "Preview": "Vorschau",
    "Principled": "Principled",
    "Quads": "Quads",
    "Ray Cast": "Raycast",
    "Ray Cast, as Printed": "Raycast, wie gedruckt",
    "Ray Visibility": "Strahlensichtbarkeit",
    ("Read a PLY file as surfels: one that this extension wrote, flat Gaussian splats, or the points of any other"): (
        "Eine PLY-Datei als Surfels lesen: eine von dieser Erweiterung geschriebene, flache Gaussian Splats "
        "oder die Punkte jeder anderen"
    ),
    "Reduction": "Reduktion",
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
        "Sample the mesh when it is first drawn; its surfels follow it as it deforms. That takes 1 to 3 "
        "microseconds a surfel in each frame in which it deforms"
    ): (
        "Das Mesh abtasten, wenn es zum ersten Mal gezeichnet wird; seine Surfels folgen ihm, wenn es sich "
        "verformt. Das kostet 1 bis 3 Mikrosekunden pro Surfel in jedem Einzelbild, in dem es sich verformt"
    ),
    (
        "Sample what is selected, as its modifiers make it, into new objects of surfels that lie exactly "
        "over it: meshes, curves, texts, metaballs, and the instances of Geometry Nodes and collections"
    ): (
        "Die Auswahl, wie ihre Modifikatoren sie formen, in neue Surfelobjekte abtasten, die genau "
        "darüberliegen: Meshes, Kurven, Texte, Metabälle und die Instanzen von Geometry Nodes und Sammlungen"
    ),
    "Samples": "Samples",
    (
        "Samples along each side of a pixel in final renders, so 3 means 9 samples. Use 1 with Mip Filter; "
        "with Quads, 2 takes 1.3 times and 4 takes 2.1 times the time"
    ): (
        "Samples entlang jeder Seite eines Pixels beim endgültigen Rendern, 3 bedeutet also 9 Samples. Beim "
        "Mip-Filter 1 verwenden; bei Quads braucht 2 die 1,3-fache und 4 die 2,1-fache Zeit"
    ),
    "Samples along each side of a pixel in the viewport": (
        "Samples entlang jeder Seite eines Pixels im Ansichtsfenster"
    ),
    (
        "Samples are dropped where the surface is turned away from their axis by more than this angle. 90 "
        "degrees keeps all of them"
    ): (
        "Proben fallen weg, wo die Fläche um mehr als diesen Winkel von ihrer Achse abgewandt ist. 90 Grad behält alle"
    ),
    "Sampling": "Sampling",
    "Scene's Resolution": "Auflösung der Szene",
    "Selected Only": "Nur Auswahl",
    "Shading": "Schattierung",
    "Shadow": "Schatten",
    "Shadows": "Schatten",
    "Show with Surfel Splatting": "Mit Surfel Splatting zeigen",
    (
        "Smooth and still at one sample a pixel: 40 to 47 dB in 1.3 to 1.9 times the time of Quads (this "
        "project, after Zwicker et al. 2001)"
    ): (
        "Glatt und ruhig bei einem Sample pro Pixel: 40 bis 47 dB in der 1,3- bis 1,9-fachen Zeit von Quads "
        "(dieses Projekt, nach Zwicker et al. 2001)"
    ),
    "Softness": "Weichheit",
    "Source": "Quelle",
    "Space": "Raum",
    "Spacing": "Abstand",
    "Splat Size": "Splatgröße",
    "Split by Distance": "Nach Entfernung teilen",
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
    "Sums": "Summen",
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
        "Surfels end at creases, borders of colours and open borders, and blend as deep as their surface "
        "asks for. It takes 8 to 12 bytes a surfel, and a frame takes up to 1.1 times as long"
    ): (
        "Surfels enden an Falten, Farbgrenzen und offenen Rändern und mischen sich so tief, wie ihre Fläche "
        "es verlangt. Das kostet 8 bis 12 Byte pro Surfel, und ein Einzelbild braucht bis zu 1,1-mal so lange"
    ),
    "Temperature": "Temperatur",
    ("Texels along each side of a shadow map; 0 turns shadows off. Each map takes the time of one visibility pass"): (
        "Texel entlang jeder Seite einer Schattenkarte; 0 schaltet Schatten aus. Jede Karte braucht die Zeit "
        "eines Sichtbarkeitsdurchgangs"
    ),
    "Text": "Text",
    "Texture-Mapped": "Mit Texturen",
    "The classic filter, in the picture; blurs silhouettes (Zwicker et al. 2001, Ren et al. 2002)": (
        "Der klassische Filter, im Bild; macht Umrisse unscharf (Zwicker et al. 2001, Ren et al. 2002)"
    ),
    (
        "The direction that the surface faces in the world, -1 to 1 on each axis as 0 to 1 of red, green and "
        "blue (none needed). 1 times the frame of Flat"
    ): (
        "Die Richtung in der Welt, in die die Fläche zeigt, -1 bis 1 auf jeder Achse als 0 bis 1 von Rot, "
        "Grün und Blau (keine Quelle nötig). 1-mal das Einzelbild von Flach"
    ),
    (
        "The distance along the view, from black at the nearest to white at the farthest of what is in view "
        "(none needed). 1 times the frame of Flat"
    ): (
        "Die Entfernung in Blickrichtung, von Schwarz am nächsten bis Weiß am fernsten Punkt, der zu sehen "
        "ist (keine Quelle nötig). 1-mal das Einzelbild von Flach"
    ),
    (
        "The fastest picture without holes: 19 to 31 dB and FLIP 0.02 to 0.06 from filtered pixels, 21 to 35 "
        "dB from box pixels, in the least time"
    ): (
        "Das schnellste Bild ohne Löcher: 19 bis 31 dB und FLIP 0,02 bis 0,06 von gefilterten Pixeln, 21 bis "
        "35 dB von Box-Pixeln, in der kürzesten Zeit"
    ),
    (
        "The least samples of a final render with depth of field or motion blur, which one sample does not "
        "show. Each takes a picture's time; at 1 Samples alone counts"
    ): (
        "Die wenigsten Samples eines endgültigen Renderns mit Tiefen- oder Bewegungsunschärfe, die ein "
        "einzelnes Sample nicht zeigt. Jedes braucht die Zeit eines Bilds; bei 1 zählt allein Samples"
    ),
    "The object is drawn as polygons where its weights are 0.5 or more": (
        "Das Objekt wird als Polygone gezeichnet, wo ihre Gewichte 0,5 oder mehr sind"
    ),
    "The object's own space, so that its scale also scales the spacing": (
        "Der Raum des Objekts selbst, dessen Skalierung dann auch den Abstand skaliert"
    ),
    (
        "The paper's own formula: depths are off by as much as splats are flatter or steeper than 1 unit "
        "(Botsch and Kobbelt 2003, equation 4 as printed)"
    ): (
        "Die Formel des Artikels selbst: Die Tiefe ist falsch, und zwar so weit, wie Splats flacher oder "
        "steiler als 1 Einheit sind (Botsch und Kobbelt 2003, Gleichung 4 wie gedruckt)"
    ),
    (
        "The paper's own formulas: a disc that faces the ray vanishes, small ones lose their depth "
        "(Guennebaud et al. 2006, sections 3 and 4, equations 8 to 10)"
    ): (
        "Die Formeln des Artikels selbst: Eine dem Strahl zugewandte Scheibe verschwindet, kleine verlieren "
        "ihre Tiefe (Guennebaud et al. 2006, Abschnitte 3 und 4, Gleichungen 8 bis 10)"
    ),
    "The same distance between surfels in every object": ("Derselbe Abstand zwischen den Surfels in allen Objekten"),
    (
        "The same filter joined in each splat's plane, drawn as a larger quad (Ren et al. 2002; "
        "view-independent object-space surface splatting, section 3, equation 10)"
    ): (
        "Derselbe Filter, in der Ebene jedes Splats angesetzt und als größeres Quad gezeichnet (Ren et al. "
        "2002; View-independent object-space surface splatting, Abschnitt 3, Gleichung 10)"
    ),
    "The share of each pixel that surfaces cover, whatever the world behind them": (
        "Der Anteil jedes Pixels, den Flächen bedecken, welche Welt auch dahinterliegt"
    ),
    (
        "The sharpest, for stills and what is scaled down later: 34 to 54 dB and FLIP 0.002 to 0.007 from "
        "box pixels, in about 2.1 times the time of Preview. Set 5 x 5 for detail far below a pixel: 38 dB "
        "instead of 34 to 35"
    ): (
        "Am schärfsten, für Standbilder und was später verkleinert wird: 34 bis 54 dB und FLIP 0,002 bis "
        "0,007 von Box-Pixeln, in etwa der 2,1-fachen Zeit der Vorschau. Für Details weit unter einem Pixel "
        "5 x 5 setzen: 38 dB statt 34 bis 35"
    ),
    "The side to which estimated normals point; existing normals are kept": (
        "Die Seite, zu der geschätzte Normalen zeigen; vorhandene Normalen bleiben"
    ),
    "The space in which surfels are spaced evenly and lengths are measured": (
        "Der Raum, in dem Surfels gleichmäßig verteilt und Längen gemessen werden"
    ),
    (
        "The square cuts the low-pass, and large splats off the axis (Botsch et al. 2005, sections 3 and 5, "
        "within the paper's square)"
    ): (
        "Das Quadrat beschneidet den Tiefpass und große Splats abseits der Achse (Botsch et al. 2005, "
        "Abschnitte 3 und 5, im Quadrat des Artikels)"
    ),
    "The surface has an edge where it, or its shading, turns by more than this angle": (
        "Die Fläche hat eine Kante, wo sie oder ihre Schattierung sich um mehr als diesen Winkel dreht"
    ),
    (
        "The surfels go where their source goes, with its parent, animation and constraints. Off, they are a "
        "frozen copy"
    ): (
        "Die Surfels gehen dorthin, wohin ihre Quelle geht, mit deren Übergeordnetem, Animation und "
        "Einschränkungen. Sonst sind sie eine eingefrorene Kopie"
    ),
    (
        "The surfels' own colour, times that of a ball in a picture where it faces the same way (Sloan et "
        "al. 2001). 1 times the frame of Flat"
    ): (
        "Die Farbe der Surfels selbst, mal der einer Kugel in einem Bild, wo diese in dieselbe Richtung "
        "zeigt (Sloan et al. 2001). 1-mal das Einzelbild von Flach"
    ),
    "The surfels' own colour, unlit (none needed). 1 times the frame of Flat": (
        "Die Farbe der Surfels selbst, unbeleuchtet (keine Quelle nötig). 1-mal das Einzelbild von Flach"
    ),
    (
        "The weights that a sample is the mean by: 1/16 blue, 1/4 cyan, 1 green, 4 yellow, 16 and more red "
        "(none needed). 1 times the frame of Flat"
    ): (
        "Die Gewichte, mit denen ein Sample gemittelt ist: 1/16 blau, 1/4 türkis, 1 grün, 4 gelb, 16 und "
        "mehr rot (keine Quelle nötig). 1-mal das Einzelbild von Flach"
    ),
    "Their points were taken": "Ihre Punkte wurden übernommen",
    "Their surfaces were sampled": "Ihre Flächen wurden abgetastet",
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
    (
        "Use larger surfels where the surface is flat and its colour even. It helps buildings and machines, "
        "and adds 2 to 3 s for a million surfels"
    ): (
        "Größere Surfels verwenden, wo die Fläche eben und ihre Farbe gleichmäßig ist. Das hilft bei "
        "Gebäuden und Maschinen und kostet 2 bis 3 s für eine Million Surfels"
    ),
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
    "What the materials could not be read for, a line each": (
        "Wofür die Materialien nicht gelesen werden konnten, eine Zeile für jedes"
    ),
    "What the sources were converted as": "Als was die Quellen umgewandelt wurden",
    "Which samples of the three axes become surfels": "Welche Proben der drei Achsen zu Surfels werden",
    "Which trade of speed for accuracy": "Welcher Tausch von Geschwindigkeit gegen Genauigkeit",
    "Width": "Breite",
    "Width of a line, which lies on the nearer surface of a silhouette and on both sides of a crease": (
        "Breite einer Linie, die auf der näheren Fläche eines Umrisses und auf beiden Seiten einer Falte liegt"
    ),
    (
        "With Quads, a pixel fades to the background where the splats' weights sum to less than this. It "
        "takes up to a tenth more time"
    ): (
        "Bei Quads geht ein Pixel in den Hintergrund über, wo die Gewichte der Splats zusammen weniger als "
        "das ergeben. Das kostet bis zu einem Zehntel mehr Zeit"
    ),
    "World": "Welt",
    "World space, so that scaled objects are as dense as others; the surfel object has a scale of 1": (
        "Weltraum, in dem skalierte Objekte so dicht sind wie andere; das Surfelobjekt hat die Skalierung 1"
    ),
    "Write numbers that a text editor shows: a file several times as large. Surfels only": (
        "Zahlen schreiben, die ein Texteditor anzeigt: eine um ein Mehrfaches größere Datei. Nur Surfels"
    ),
    "Write surfels to a PLY file, with everything that they have or as Gaussian splats": (
        "Surfels in eine PLY-Datei schreiben, mit allem, was sie haben, oder als Gaussian Splats"
    ),
    "Write the selected surfel objects, and not all visible ones": (
        "Die ausgewählten Surfelobjekte schreiben, nicht alle sichtbaren"
    ),
    "Conversion": "Umwandlung",
    "mesh": "Mesh",
    "points": "Punkte",
    "sources": "Quellen",
}
