# SPDX-License-Identifier: GPL-3.0-or-later
"""Importing, exporting and storing files."""

TEXTS = {
    "A file of blocks takes all points; set At Most to 0": (
        "Eine Datei aus Blöcken nimmt alle Punkte; Höchstens auf 0 setzen"
    ),
    "Added to the number of a file to give the frame at which it is shown": (
        "Wird zur Nummer einer Datei addiert und ergibt das Einzelbild, in dem sie gezeigt wird"
    ),
    "All properties, exactly; other programs read the positions, normals and colours": (
        "Alle Eigenschaften, genau; andere Programme lesen die Positionen, Normalen und Farben"
    ),
    "At Most": "Höchstens",
    (
        "Blender keeps places so far out in steps of {step:.3g}, also those of cameras and lights; this engine draws "
        "and exports the surfels exactly"
    ): (
        "Blender merkt sich Orte so weit draußen in Schritten von {step:.3g}, auch die von Kameras und Lichtern; diese "
        "Engine zeichnet und exportiert die Surfels genau"
    ),
    "Columns": "Spalten",
    "Display": "Anzeige",
    "Display values (sRGB), as in Blender's own PLY import": "Anzeigewerte (sRGB) wie in Blenders eigenem PLY-Import",
    "Drop": "Entfernen",
    "Export Surfels": "Surfels exportieren",
    (
        "File from which views read the surfels that they need. The mesh has the coarsest ones, which are drawn while "
        "the file is missing"
    ): (
        "Datei, aus der Ansichten die Surfels lesen, die sie brauchen. Das Mesh hat die gröbsten, die gezeichnet "
        "werden, solange die Datei fehlt"
    ),
    "File Path": "Dateipfad",
    "Filepath used for reading from the file": "Dateipfad, von dem gelesen wird",
    "Filepath used for writing to the file": "Dateipfad, auf den geschrieben wird",
    "Flat 3D Gaussians, which viewers of Gaussian splats read": (
        "Flache 3D-Gaußverteilungen, die Betrachter von Gaussian Splats lesen"
    ),
    "Float Colors": "Fließkommafarben",
    "Frame Offset": "Einzelbildversatz",
    "Gaussian Splats": "Gaussian Splats",
    "Import": "Importieren",
    "Import Surfels": "Surfels importieren",
    "Keep in a File": "In einer Datei behalten",
    "Layout": "Aufbau",
    "Linear": "Linear",
    "mesh": "Mesh",
    "Move the surfels to a file beside the .blend, from which each view reads what it needs": (
        "Die Surfels in eine Datei neben der .blend-Datei verschieben, aus der jede Ansicht liest, was sie braucht"
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
    "Numbered Series": "Nummerierte Serie",
    "One of several numbered files, each of which is shown at the frame of its number": (
        "Eine von mehreren nummerierten Dateien, von denen jede im Einzelbild ihrer Nummer gezeigt wird"
    ),
    "Other engines show these surfels {aside:.2g} aside": "Andere Engines zeigen diese Surfels {aside:.2g} daneben",
    "points": "Punkte",
    "Points to take of a file that has more, evenly; 0 takes all": (
        "Punkte, die von einer Datei mit mehr genommen werden, gleichmäßig verteilt; 0 nimmt alle"
    ),
    (
        "Read surfels from files: those written by this extension, Gaussian splats, or scans; what a file is, its "
        "contents tell"
    ): (
        "Surfels aus Dateien lesen: aus von dieser Erweiterung geschriebenen, aus Gaussian Splats oder aus Scans; was "
        "eine Datei ist, sagt ihr Inhalt"
    ),
    "Reading {count:,} points   Esc cancels": "{count:,} Punkte gelesen   Esc bricht ab",
    "Scene-linear values": "Szenenlineare Werte",
    "Selected Only": "Nur Auswahl",
    "Series": "Serie",
    (
        "Show each of the files whose names differ in their last number at the frame of its number, such as "
        "those of a scan that moves. A file is read when its frame is shown"
    ): (
        "Jede der Dateien, deren Namen sich in der letzten Nummer unterscheiden, im Einzelbild ihrer Nummer "
        "zeigen, etwa die eines bewegten Scans. Eine Datei wird gelesen, wenn ihr Einzelbild gezeigt wird"
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
    "Skipped {count:,} unusable surfels": "{count:,} unbrauchbare Surfels ausgelassen",
    "sources": "Quellen",
    "Store Surfels in a File": "Surfels in einer Datei speichern",
    (
        "Store the surfels in a file beside the .blend, from which every view reads only what it needs, instead of in "
        "the .blend. For more surfels or points than memory holds"
    ): (
        "Die Surfels in einer Datei neben der .blend-Datei speichern, aus der jede Ansicht nur liest, was sie braucht, "
        "statt in der .blend-Datei. Für mehr Surfels oder Punkte, als der Speicher fasst"
    ),
    "Surfel File": "Surfel-Datei",
    "Surfels (.ply)": "Surfels (.ply)",
    "Surfels and Scans": "Surfels und Scans",
    "Surfels and Scans (.ply, .las, ...)": "Surfels und Scans (.ply, .las, ...)",
    (
        "Take so many points of a scan that has more, evenly; 0 takes all. Of LAS and COPC the rest is not "
        "read; LAZ is read at some millions of points a second"
    ): (
        "So viele Punkte eines Scans nehmen, der mehr hat, gleichmäßig verteilt; 0 nimmt alle. Von LAS und "
        "COPC wird der Rest nicht gelesen; LAZ wird mit einigen Millionen Punkten je Sekunde gelesen"
    ),
    "Text": "Text",
    "The files of a series are shown from memory; they cannot be files of blocks": (
        "Die Dateien einer Serie werden aus dem Speicher gezeigt; es können keine Dateien aus Blöcken sein"
    ),
    "The import was cancelled; nothing was changed": "Der Import wurde abgebrochen; nichts wurde verändert",
    (
        "The name has no number that counts the files of a series; import it without Numbered Series"
    ): "Der Name hat keine Nummer, die die Dateien einer Serie zählt; ohne Nummerierte Serie importieren",
    "The surfels belong to a linked file; store them there": (
        "Die Surfels gehören zu einer verknüpften Datei; dort speichern"
    ),
    "The surfels of {names} are in files of their own; only the coarsest were written": (
        "Die Surfels von {names} liegen in eigenen Dateien; nur die gröbsten wurden geschrieben"
    ),
    "Took {count:,} files as a series, for the frames {first:,} to {last:,}": (
        "{count:,} Dateien als Serie genommen, für die Einzelbilder {first:,} bis {last:,}"
    ),
    "Took {offset} from the coordinates; later files share that offset": (
        "{offset} von den Koordinaten abgezogen; spätere Dateien haben denselben Versatz"
    ),
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
    "What the file holds": "Was die Datei enthält",
    "What the file's colours mean if they are floats and the file does not say it": (
        "Was die Farben der Datei bedeuten, wenn sie Fließkommazahlen sind und die Datei es nicht sagt"
    ),
    "What the files' colours mean if they are floats and the files do not say it": (
        "Was die Farben der Dateien bedeuten, wenn sie Gleitkommazahlen sind und die Dateien es nicht sagen"
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
    "{count:,} surfels -> {path}": "{count:,} Surfels -> {path}",
    "{count:,} surfels of {objects} objects -> {path}": "{count:,} Surfels von {objects} Objekten -> {path}",
    "{name}: {count:,} surfels": "{name}: {count:,} Surfels",
    "{path} cannot be written: {why}": "{path} kann nicht geschrieben werden: {why}",
}
