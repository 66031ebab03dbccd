# SPDX-License-Identifier: GPL-3.0-or-later
"""How a mesh is sampled: densities, reductions and their like, and the predicted count and error."""

TEXTS = {
    "3-to-1": "3 zu 1",
    "A number of grid cells along the longest edge of each object's bounding box": (
        "Eine Anzahl von Gitterzellen entlang der längsten Kante des Begrenzungsrahmens jedes Objekts"
    ),
    "A number of surfels for each object": "Eine Anzahl von Surfels für jedes Objekt",
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
    "Counting …": "Wird gezählt …",
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
    "Do not draw them": "Nicht zeichnen",
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
    "Follow the setting Render Meshes as in the render properties": (
        "Der Einstellung Meshes als in den Rendereigenschaften folgen"
    ),
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
    (
        "How many times closer together this object's surfels are than the density says. 2 makes four times "
        "as many surfels"
    ): ("Wievielmal dichter die Surfels dieses Objekts liegen, als die Dichte sagt. 2 ergibt viermal so viele Surfels"),
    "How meshes, curves, texts and metaballs are drawn if they have not been converted": (
        "Wie Meshes, Kurven, Texte und Metabälle gezeichnet werden, die nicht umgewandelt wurden"
    ),
    "How the distance between the surfels of meshes is chosen": (
        "Wie der Abstand zwischen den Surfels von Meshes gewählt wird"
    ),
    (
        "How this object and its instances are drawn. From Scene draws its surfels instead of the object for as "
        "long as they exist"
    ): (
        "Wie dieses Objekt und seine Instanzen gezeichnet werden. Aus Szene zeichnet statt des Objekts seine "
        "Surfels, solange es sie gibt"
    ),
    (
        "Let the shading normal change over each surfel. Surfels that are several pixels large are lit more like "
        "the curved surface that they stand for, but take slightly more memory"
    ): (
        "Die Normale der Schattierung über jedem Surfel ändern. Surfels, die mehrere Pixel groß sind, werden eher "
        "wie die gekrümmte Fläche beleuchtet, für die sie stehen, brauchen aber etwas mehr Speicher"
    ),
    (
        "Look up the base colour's image for every pixel instead of once per surfel. Textures are much "
        "sharper, but frames take several times as long without a graphics card"
    ): (
        "Das Bild der Grundfarbe für jeden Pixel nachschlagen statt einmal pro Surfel. Texturen werden viel "
        "schärfer, aber Einzelbilder dauern ohne Grafikkarte um ein Mehrfaches länger"
    ),
    "Nothing to sample: no faces, or a density of 0": "Nichts abzutasten: keine Flächen oder eine Dichte von 0",
    "Object Detail": "Objektdetail",
    "Phong Splatting": "Phong-Splatting",
    "Pixels per Surfel": "Pixel pro Surfel",
    "Polygons": "Polygone",
    "Render as": "Rendern als",
    "Render Meshes as": "Meshes als",
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
        "Sample along all three axes and keep the surfels whose smoothed normals face their axis most. It leaves "
        "small holes where normals turn, and takes longer, because every face is sampled three times"
    ): (
        "Entlang aller drei Achsen abtasten und die Surfels behalten, deren geglättete Normalen ihrer Achse am "
        "meisten zugewandt sind. Lässt kleine Löcher, wo Normalen sich drehen, und dauert länger, weil jede Fläche "
        "dreimal abgetastet wird"
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
    "Splat Size": "Splatgröße",
    "Split by Distance": "Nach Entfernung teilen",
    "Split by Spacing": "Nach Abstand teilen",
    "Split by Vertex Group": "Nach Vertexgruppe teilen",
    "Style": "Stil",
    "Surfel's Normal": "Normale des Surfels",
    "Texture-Mapped": "Mit Texturen",
    "The object is drawn as polygons where its surfels are more pixels apart than this": (
        "Das Objekt wird als Polygone gezeichnet, wo seine Surfels mehr Pixel auseinander sind als dieser Wert"
    ),
    "The object is drawn as polygons where its weights are 0.5 or more": (
        "Das Objekt wird als Polygone gezeichnet, wo ihre Gewichte 0,5 oder mehr sind"
    ),
    "The same distance between surfels in every object": ("Derselbe Abstand zwischen den Surfels in allen Objekten"),
    "Vertex Group": "Vertexgruppe",
    "{count}, fewer where flat": "{count}, weniger wo eben",
    "≈ {count:,} surfels, spacing {low} to {high}": "≈ {count:,} Surfels, Abstand {low} bis {high}",
    "≈ {count:,} surfels, spacing {spacing}": "≈ {count:,} Surfels, Abstand {spacing}",
}
