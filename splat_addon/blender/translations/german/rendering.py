# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine: its settings, its panels, and what it says of a picture."""

TEXTS = {
    (
        "A crease is drawn where the surface turns by more than this angle within about 3 pixels; 180 "
        "degrees draws none"
    ): (
        "Eine Falte wird gezeichnet, wo sich die Fläche innerhalb von etwa 3 Pixeln um mehr als diesen Winkel "
        "dreht; 180 Grad zeichnet keine"
    ),
    "Add a preset of all render settings of Surfel Splatting, or remove one": (
        "Eine Voreinstellung aller Rendereinstellungen von Surfel Splatting hinzufügen oder eine entfernen"
    ),
    "Add Surfel Splatting Preset": "Surfel-Splatting-Voreinstellung hinzufügen",
    "Additional Depth": "Zusätzliche Tiefe",
    ("Also draw a line where a surface is seen at less than this angle; 0 draws none. It takes no extra time"): (
        "Auch dort eine Linie zeichnen, wo eine Fläche flacher als unter diesem Winkel gesehen wird; 0 zeichnet "
        "keine. Braucht keine zusätzliche Zeit"
    ),
    (
        "Also draw lines where surfaces of different objects cut through each other or lie in one plane. Frames "
        "take longer"
    ): (
        "Linien auch dort zeichnen, wo sich Flächen verschiedener Objekte durchdringen oder in einer Ebene "
        "liegen. Bilder dauern länger"
    ),
    "Ambient Occlusion": "Umgebungsverdeckung",
    "As in the Papers": "Wie in den Veröffentlichungen",
    "As Printed": "Wie gedruckt",
    "Back-facing splats left out: {culled:,} ({percent:.0f}%)": (
        "Weggelassene abgewandte Splats: {culled:,} ({percent:.0f}%)"
    ),
    "Blend Depth": "Mischtiefe",
    "Blend Precision": "Genauigkeit der Mischung",
    "Blend the Rest": "Rest mischen",
    "Blur Samples": "Unschärfe-Samples",
    "Bounced Light": "Indirektes Licht",
    "Bounces": "Reflexionen",
    "Broken Objects": "Fehlerhafte Objekte",
    "Choose method and samples together": "Methode und Samples zusammen wählen",
    "Compiling shaders": "Shader werden kompiliert",
    "Conversion": "Umwandlung",
    "Conversion in New Scenes": "Umwandlung in neuen Szenen",
    "Coverage": "Bedeckung",
    "Cryptomatte": "Cryptomatte",
    (
        "Darken surfaces whose surroundings rise towards the viewer, with any shading and without any light. It shows "
        "the shape of scans. Frames take slightly longer"
    ): (
        "Flächen abdunkeln, deren Umgebung sich zum Betrachter hin erhebt, mit jeder Schattierung und ohne Licht. "
        "Zeigt die Form von Scans. Einzelbilder dauern etwas länger"
    ),
    "Depth Threshold": "Tiefenschwelle",
    "Detail Tolerance": "Detailtoleranz",
    "Device: {device}, {backend}": "Gerät: {device}, {backend}",
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
    "Drawn: {splats_drawn:,} of {splats:,} splats, and {polygons:,} polygons": (
        "Gezeichnet: {splats_drawn:,} von {splats:,} Splats und {polygons:,} Polygone"
    ),
    "Edge Fade": "Randverlauf",
    "Environment": "Umgebung",
    "Eye-Dome Lighting": "Eye-Dome-Beleuchtung",
    (
        "Fade pixels to the background where their splats' weights sum to less than this. It has no effect with Mip "
        "Filter, which filters silhouettes itself. Frames take slightly longer"
    ): (
        "Pixel zum Hintergrund verlaufen lassen, wo die Summe der Gewichte ihrer Splats kleiner ist. Ohne Wirkung "
        "auf Mip Filter, der Silhouetten selbst filtert. Einzelbilder dauern etwas länger"
    ),
    "Fewer samples than the viewport": "Weniger Samples als im Ansichtsfenster",
    "Film": "Film",
    "Filter": "Filter",
    "Filter Variance": "Filtervarianz",
    (
        "Follow the papers: back faces and large splats count as much as others, EWA has its printed filter, and "
        "all surfaces that are left for the last transparent layer count as one. It takes no extra time, but far "
        "sides show at the rims of open surfaces"
    ): (
        "Den Veröffentlichungen folgen: Rückseiten und große Splats zählen so viel wie andere, EWA hat den gedruckten "
        "Filter, und alle Flächen, die für die letzte durchsichtige Schicht übrig sind, zählen als eine. Braucht keine "
        "zusätzliche Zeit, aber an Rändern offener Flächen sind abgewandte Seiten zu sehen"
    ),
    "Graphics Device": "Grafikgerät",
    "How a splat is drawn and filtered": "Wie ein Splat gezeichnet und gefiltert wird",
    (
        "How far away a surface can be and still block the world's light; 0 for half the distance to the camera, and "
        "for none with Captured Color"
    ): (
        "Wie weit entfernt eine Fläche sein und das Licht der Welt noch abhalten kann; bei 0 halb so weit wie die "
        "Kamera, und bei Aufgenommener Farbe keine"
    ),
    "How far away the eight places are that each is compared with: the width of dark rims": (
        "Wie weit die acht Stellen entfernt sind, mit denen jede verglichen wird: die Breite dunkler Ränder"
    ),
    (
        "How far behind the nearest splat others still blend with it, in splat radii. Lower values separate "
        "thin sheets; below 0.2 the surface breaks up"
    ): (
        "Wie weit hinter dem nächsten Splat andere sich noch mit ihm mischen, in Splatradien. Kleinere Werte "
        "trennen dünne Schichten; unter 0,2 bricht die Fläche auf"
    ),
    "How much deeper the next surface must lie for a silhouette, in pixels at that distance": (
        "Wie viel tiefer die nächste Fläche für einen Umriss liegen muss, in Pixeln bei dieser Entfernung"
    ),
    (
        "How much farther behind the nearest splat others still blend with it, the same for all splats. The papers "
        "have this alone: set Blend Depth to 0"
    ): (
        "Wie viel weiter hinter dem nächsten Splat andere noch mit ihm mischen, für alle Splats gleich. Die "
        "Veröffentlichungen haben nur das: Mischtiefe dazu auf 0 setzen"
    ),
    "How much steps in depth darken what lies behind them": (
        "Wie sehr Stufen in der Tiefe abdunkeln, was hinter ihnen liegt"
    ),
    "How often light is reflected from surface to surface": "Wie oft Licht von Fläche zu Fläche reflektiert wird",
    "How surfels are stored on the graphics device": "Wie Surfels auf dem Grafikgerät gespeichert werden",
    "How the sums of overlapping splats are stored": "Wie die Summen überlappender Splats gespeichert werden",
    "Include": "Einschließen",
    "Last Picture": "Letztes Bild",
    "Layers": "Schichten",
    "Leave Out Backs": "Rückseiten weglassen",
    (
        "Leave out splats that face away, even on open surfaces, which then have holes. It saves up to half of the time"
    ): ("Abgewandte Splats weglassen, auch auf offenen Flächen, die dann Löcher haben. Spart bis zur Hälfte der Zeit"),
    (
        "Let glass show what stands behind it, bent, tinted and blurred; otherwise it is opaque. What is behind is "
        "drawn again for each view"
    ): (
        "Glas zeigen lassen, was dahinter steht, gebrochen, gefärbt und unscharf; sonst ist es undurchsichtig. Was "
        "dahinter ist, wird für jede Ansicht neu gezeichnet"
    ),
    ("Let glossy objects reflect what stands around them. It is drawn from each of them when it has changed"): (
        "Glänzende Objekte spiegeln lassen, was um sie herum steht. Es wird von jedem aus gezeichnet, wenn es sich "
        "geändert hat"
    ),
    (
        "Let surfaces light one another, and keep the world's light from one another. It is computed for the whole "
        "scene when that has changed, which takes some seconds, and takes the place of Ambient Occlusion"
    ): (
        "Flächen einander beleuchten und das Licht der Welt voneinander abhalten lassen. Es wird für die ganze Szene "
        "berechnet, wenn sie sich geändert hat, was einige Sekunden dauert, und ersetzt Umgebungsverdeckung"
    ),
    ("Let visible surfaces block the world's light from one another. Frames take slightly longer"): (
        "Sichtbare Flächen das Licht der Welt voneinander abhalten lassen. Einzelbilder dauern etwas länger"
    ),
    "Levels": "Stufen",
    "Light Each Splat": "Jeden Splat beleuchten",
    (
        "Light every splat by itself and blend the lit colours, as in papers before deferred shading. The time "
        "grows with the number of surfels instead of samples"
    ): (
        "Jeden Splat für sich beleuchten und die beleuchteten Farben mischen, wie in Veröffentlichungen vor dem "
        "Deferred Shading. Die Zeit wächst mit der Zahl der Surfels statt der Samples"
    ),
    (
        "Maximum memory in megabytes that a final render, and each 3D view, may use for the surfels of each file that "
        "they are read from. Parts of a picture that need more are drawn coarser"
    ): (
        "Höchstens so viele Megabyte Speicher darf ein endgültiger Render und jede 3D-Ansicht für die Surfels jeder "
        "Datei benutzen, aus der sie gelesen werden. Teile eines Bildes, die mehr brauchen, werden gröber gezeichnet"
    ),
    (
        "Maximum memory in megabytes that a final render, and each 3D view, may use on the graphics device. A"
        " picture that needs more stops with a message. 0 sets no limit"
    ): (
        "Höchster Speicher in Megabyte, den ein endgültiges Rendern und jede 3D-Ansicht auf dem Grafikgerät "
        "belegen dürfen. Ein Bild, das mehr braucht, bricht mit einer Meldung ab. 0 setzt keine Grenze"
    ),
    "Measure how long each pass takes, by waiting for the graphics device after each": (
        "Messen, wie lange jeder Durchgang braucht, indem nach jedem auf das Grafikgerät gewartet wird"
    ),
    "Memory of a Picture": "Speicher eines Bilds",
    "Memory of a Surfel File": "Speicher einer Surfel-Datei",
    "Meshes": "Meshes",
    "Method": "Methode",
    (
        "Minimum number of samples of a final render with depth of field or motion blur, because a single sample "
        "shows no blur. Set it to 1 so that only Samples counts"
    ): (
        "Mindestzahl der Samples eines endgültigen Renderns mit Tiefen- oder Bewegungsunschärfe, weil ein "
        "einzelnes Sample keine Unschärfe zeigt. Auf 1 setzen, damit allein Samples zählt"
    ),
    "Mix all surfaces behind the last layer by their opacity, without sorting them. If off, they are left out": (
        "Alle Flächen hinter der letzten Schicht nach ihrer Deckkraft mischen, ohne sie zu sortieren. Sonst "
        "werden sie weggelassen"
    ),
    "Motion Blur": "Bewegungsunschärfe",
    "Nothing has been rendered yet": "Noch wurde nichts gerendert",
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
    "Number of splats blended in a sample, averaged over the pixel. Frames take slightly longer": (
        "Anzahl der Splats, die in einem Sample gemischt werden, gemittelt über den Pixel. Einzelbilder dauern etwas "
        "länger"
    ),
    (
        "Number of times during the open shutter at which the scene is evaluated. Fewer are faster, but show "
        "moving objects as separate pictures"
    ): (
        "Anzahl der Zeitpunkte des offenen Verschlusses, an denen die Szene ausgewertet wird. Weniger sind "
        "schneller, zeigen aber bewegte Objekte als einzelne Bilder"
    ),
    (
        "Number of transparent surfaces behind one another that are sorted exactly. Each takes about the "
        "time of an opaque frame"
    ): (
        "Anzahl transparenter Flächen hintereinander, die genau sortiert werden. Jede braucht etwa die Zeit "
        "eines deckenden Einzelbilds"
    ),
    "One warning: see Render Properties > Last Picture": "Eine Warnung: siehe Rendereigenschaften > Letztes Bild",
    "Only for Cycles; choose another type": "Nur für Cycles; einen anderen Typ wählen",
    "Override": "Überschreiben",
    "Panorama": "Panorama",
    "Passes": "Durchgänge",
    "Performance": "Leistung",
    "Persistent Data": "Beständige Daten",
    (
        "Pictures per second of a viewport that moves. If they take longer, they have larger surfels and fewer "
        "pixels, until the view rests. 0 always draws all of them"
    ): (
        "Bilder pro Sekunde eines Ansichtsfensters, das sich bewegt. Dauern sie länger, haben sie größere Surfels und "
        "weniger Pixel, bis die Ansicht ruht. 0 zeichnet immer alle"
    ),
    "Plan": "Plan",
    "Preparing surfels": "Surfels werden vorbereitet",
    "Preset": "Voreinstellung",
    "Reflections": "Spiegelungen",
    "Refraction": "Lichtbrechung",
    "Render": "Rendern",
    "Render without them, and name them in a warning": "Ohne sie rendern und sie in einer Warnung nennen",
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
    "Samples: {samples}": "Samples: {samples}",
    "Sampling": "Sampling",
    "Shadow Resolution": "Auflösung der Schatten",
    "Shadows": "Schatten",
    "Shallow Angle": "Flacher Winkel",
    "Show with Surfel Splatting": "Mit Surfel Splatting zeigen",
    "Shown by its first layer, without highlights": "Durch die erste Schicht gezeigt, ohne Glanzlichter",
    "Shutter Steps": "Schritte des Verschlusses",
    "Simplify": "Vereinfachen",
    "Stop": "Abbrechen",
    "Stop in Background": "Im Hintergrund abbrechen",
    "Stop in the background, so that a render farm notices; warn in the interface": (
        "Im Hintergrund abbrechen, damit eine Renderfarm es bemerkt; in der Oberfläche warnen"
    ),
    "Stop the render": "Das Rendern abbrechen",
    "Sun": "Sonne",
    "Supersampling": "Supersampling",
    "Surfel Splatting Preset": "Surfel-Splatting-Voreinstellung",
    "Surfel Splatting Presets": "Surfel-Splatting-Voreinstellungen",
    "Surfel Storage": "Surfelspeicher",
    ("Texels along each side of a shadow map; 0 turns shadows off. Each light with shadows adds one or several maps"): (
        "Texel entlang jeder Seite einer Schattenkarte; 0 schaltet Schatten aus. Jede Lampe mit Schatten fügt"
        " eine oder mehrere Karten hinzu"
    ),
    "Textures on the device: {megabytes:,.1f} MB": "Texturen auf dem Gerät: {megabytes:,.1f} MB",
    "The balance between speed and accuracy": "Das Verhältnis von Geschwindigkeit und Genauigkeit",
    "The share of each pixel that surfaces cover, regardless of the background": (
        "Der Anteil jedes Pixels, den Flächen bedecken, unabhängig vom Hintergrund"
    ),
    "Three even greys, as with Toon": "Drei gleichmäßige Graustufen wie bei Toon",
    "Threshold": "Schwellenwert",
    "Time Each Pass": "Durchgänge messen",
    "Time: {milliseconds:,.0f} ms": "Zeit: {milliseconds:,.0f} ms",
    "Times": "Zeiten",
    "Transparency": "Transparenz",
    "Transparent": "Transparent",
    (
        "Variance of the Gaussian that filters a pixel, in square pixels, for methods that have one. Higher values "
        "are smoother. The papers have 1. Mip Filter takes at most 0.66"
    ): (
        "Varianz der Gaußkurve, die ein Pixel filtert, in Quadratpixeln, für Verfahren, die eine haben. Höhere Werte "
        "sind weicher. Die Veröffentlichungen haben 1. Mip-Filter nimmt höchstens 0,66"
    ),
    "Viewport": "Ansichtsfenster",
    "Viewport Rate": "Rate im Ansichtsfenster",
    "Viewport Samples": "Samples der Ansicht",
    "Viewport Supersampling": "Supersampling der Ansicht",
    "Warn": "Warnen",
    (
        "What happens to a final render when an object or a light cannot be drawn. A render that stops "
        "writes no file, and Blender in the background ends with exit code 1"
    ): (
        "Was mit einem endgültigen Rendern geschieht, wenn ein Objekt oder eine Lampe nicht gezeichnet "
        "werden kann. Ein abgebrochenes Rendern schreibt keine Datei, und Blender im Hintergrund endet mit "
        "Rückgabewert 1"
    ),
    "Where Objects Meet": "Wo sich Objekte treffen",
    "Width of the lines. At a silhouette a line lies on the nearer surface; at a crease it covers both sides": (
        "Breite der Linien. An einem Umriss liegt eine Linie auf der näheren Fläche; an einer Falte bedeckt sie beide "
        "Seiten"
    ),
    "{blur} needs more samples": "{blur} braucht mehr Samples",
    "{count} warnings: see Render Properties > Last Picture": (
        "{count} Warnungen: siehe Rendereigenschaften > Letztes Bild"
    ),
}
