# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings cost and gain in a scene: measuring, its table, and the aim of a render."""

TEXTS = {
    "Aim": "Ziel",
    "Choose the engine Surfel Splatting first": "Wählen Sie zuerst die Engine Surfel Splatting",
    "Click to use": "Klick übernimmt",
    "Exact Pictures": "Exakte Bilder",
    "Go On": "Fortsetzen",
    (
        "How far a picture may be from the exact one of the same surfels, as its mean perceived difference, from 0 "
        "to 1. Few people see less than 0.01"
    ): (
        "Wie weit ein Bild vom exakten Bild derselben Surfels entfernt sein darf, als mittlerer wahrgenommener "
        "Unterschied von 0 bis 1. Weniger als 0,01 sehen nur wenige"
    ),
    "How often each picture is drawn to measure its time": (
        "Wie oft jedes Bild gezeichnet wird, um seine Zeit zu messen"
    ),
    "Keep what was measured before, if settings and size are the same": (
        "Behalten, was vorher gemessen wurde, wenn Einstellungen und Größe gleich sind"
    ),
    "Measure This Scene": "Diese Szene messen",
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
    "Save Page": "Seite speichern",
    "Save the table, a plot and the pictures as one HTML page, which needs no other file": (
        "Tabelle, Diagramm und Bilder als eine HTML-Seite speichern, die keine andere Datei braucht"
    ),
    "Seconds": "Sekunden",
    "Settings": "Einstellungen",
    "Show Difference": "Unterschied zeigen",
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
    "The settings below": "Die Einstellungen darunter",
    "The table has {count} rows, from 0 on, and no row {row}": (
        "Die Tabelle hat {count} Zeilen, von 0 an, und keine Zeile {row}"
    ),
    "The time that a frame may take, from reading the scene to its last sample": (
        "Die Zeit, die ein Bild dauern darf, vom Lesen der Szene bis zum letzten Sample"
    ),
    "Time Budget": "Zeitbudget",
    "What decides method, samples and detail of a final render": (
        "Was Methode, Samples und Detail eines Endrenderns bestimmt"
    ),
    "Which row of the table": "Welche Zeile der Tabelle",
}
