# SPDX-License-Identifier: GPL-3.0-or-later
"""Methods, shading models, storages and presets: what is chosen from the registries of the renderer."""

TEXTS = {
    "16 Bit": "16 Bit",
    "An image of a lit ball that fills the frame. A multilayer file shows its first layer": (
        "Ein Bild einer beleuchteten Kugel, die das Bild ausfüllt. Von einer mehrschichtigen Datei wird die "
        "erste Schicht gezeigt"
    ),
    "Balanced": "Ausgewogen",
    "Captured Color": "Aufgenommene Farbe",
    ("Diffuse and GGX specular light of the scene's lights and world (Walter et al. 2007, Heitz et al. 2016)"): (
        "Diffuses und glänzendes (GGX-)Licht der Lampen und der Welt (Walter et al. 2007, Heitz et al. 2016)"
    ),
    (
        "Discs in point sprites that are not blended: each pixel shows the nearest; faster than Quads (Botsch and "
        "Kobbelt 2003, sections 3.1 and 3.2)"
    ): (
        "Scheiben in Punktsprites, die nicht gemischt werden: Jedes Pixel zeigt die nächste; schneller als Quads "
        "(Botsch und Kobbelt 2003, Abschnitte 3.1 und 3.2)"
    ),
    "Discs in point sprites, with holes at grazing angles (Botsch and Kobbelt 2003, sections 3.1 to 3.4)": (
        "Scheiben in Punktsprites, mit Löchern bei flachen Winkeln (Botsch und Kobbelt 2003, Abschnitte 3.1 bis 3.4)"
    ),
    (
        "Draws each splat in the paper's square, which cuts off its filter, and cuts large splats away from the "
        "axis (Botsch et al. 2005, sections 3 and 5, within the paper's square)"
    ): (
        "Zeichnet jeden Splat im Quadrat der Veröffentlichung, das seinen Filter abschneidet, und große Splats "
        "abseits der Achse beschneidet (Botsch et al. 2005, Abschnitte 3 und 5, im Quadrat des Artikels)"
    ),
    "EWA": "EWA",
    (
        "EWA computed in each splat's plane, which is drawn as a larger quad (Ren et al. 2002; "
        "view-independent object-space surface splatting, section 3, equation 10)"
    ): (
        "EWA, in der Ebene jedes Splats berechnet, der als größeres Quad gezeichnet wird (Ren et al. 2002; "
        "View-independent object-space surface splatting, Abschnitt 3, Gleichung 10)"
    ),
    "EWA in Space": "EWA im Raum",
    "Exact ellipses, no smaller than the pixel's disc (Botsch et al. 2005, sections 3 and 5)": (
        "Genaue Ellipsen, nicht kleiner als die Scheibe des Pixels (Botsch et al. 2005, Abschnitte 3 und 5)"
    ),
    (
        "Exact ellipses, no smaller than the pixel's filter, with correct depth; more accurate at grazing "
        "angles (Guennebaud et al. 2006, sections 3 and 4, repaired)"
    ): (
        "Genaue Ellipsen, nicht kleiner als der Filter des Pixels, mit richtiger Tiefe; bei flachen Winkeln "
        "genauer (Guennebaud et al. 2006, Abschnitte 3 und 4, berichtigt)"
    ),
    "Exact, even with thousands of splats over a pixel": ("Genau, auch bei Tausenden von Splats über einem Pixel"),
    "Exact, with twice the memory of 16 Bit": "Genau, mit doppelt so viel Speicher wie 16 Bit",
    (
        "Filtered, so that animations and fine textures are smooth and do not flicker. A sample takes longer "
        "than one of Preview; 16 samples smooth creases and polygons"
    ): (
        "Gefiltert, damit Animationen und feine Texturen glatt sind und nicht flimmern. Ein Sample dauert "
        "länger als eines der Vorschau; 16 Samples glätten Falten und Polygone"
    ),
    (
        "Filters each splat exactly: smooth and free of flicker at one sample per pixel, slower than Quads "
        "(this project, after Zwicker et al. 2001)"
    ): (
        "Filtert jeden Splat genau: glatt und flimmerfrei bei einem Sample pro Pixel, langsamer als Quads "
        "(dieses Projekt, nach Zwicker et al. 2001)"
    ),
    "Final": "Endgültig",
    "Flat": "Flach",
    "Float 16": "Float 16",
    "Float 32": "Float 32",
    "Homogeneous": "Homogen",
    "Homogeneous, as Printed": "Homogen, wie gedruckt",
    "How much of each level blends into the next; at 0 edges are jagged": (
        "Wie viel jeder Stufe in die nächste übergeht; bei 0 sind Kanten gezackt"
    ),
    "How the surface reflects light": "Wie die Oberfläche Licht zurückwirft",
    "Levels of brightness that each light is shown in": "Helligkeitsstufen, in denen jede Lampe gezeigt wird",
    "Mip Filter": "Mip-Filter",
    (
        "No filter: fast, and with many samples the sharpest (View-independent object-space surface "
        "splatting, sections 4.1 to 4.3)"
    ): (
        "Kein Filter: schnell und mit vielen Samples am schärfsten (View-independent object-space "
        "surface splatting, Abschnitte 4.1 bis 4.3)"
    ),
    "Normals": "Normalen",
    ("Number of splats blended in each sample: 1 blue, 4 cyan, 16 green, 64 yellow, 256 and more red"): (
        "Anzahl der Splats, die in jedem Sample gemischt werden: 1 blau, 4 türkis, 16 grün, 64 gelb, 256 und mehr rot"
    ),
    "Phong": "Phong",
    "Principled": "Principled",
    "Quads": "Quads",
    "Ray Cast": "Raycast",
    "Ray Cast, as Printed": "Raycast, wie gedruckt",
    ("Shows each light in a few even steps, with a sharp-edged highlight (Lake et al. 2000)"): (
        "Jede Lampe in wenigen gleichmäßigen Stufen, mit einem scharf begrenzten Glanzlicht (Lake et al. 2000)"
    ),
    "Softness": "Weichheit",
    "Sprites": "Sprites",
    "Sprites, as Printed": "Sprites, wie gedruckt",
    "Sprites, Unfiltered": "Sprites, ungefiltert",
    "Takes half the memory; differences from Float 32 are invisible": (
        "Braucht halb so viel Speicher; Unterschiede zu Float 32 sind unsichtbar"
    ),
    "Takes less memory. Precise with hundreds of splats over a pixel, wrong with thousands": (
        "Braucht weniger Speicher. Genau bei Hunderten von Splats über einem Pixel, falsch bei Tausenden"
    ),
    (
        "Texture whose color ramp is looked up by the amount of light, from none at the left to full light at the "
        "right. Without a texture, three even greys are used. It takes as long as Toon"
    ): (
        "Textur, in deren Farbverlauf nach der Menge des Lichts nachgeschlagen wird, von keinem links bis zu vollem "
        "Licht rechts. Ohne Textur werden drei gleichmäßige Graustufen verwendet. Dauert so lange wie Toon"
    ),
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
        "The sharpest, for stills and for pictures that are scaled down later. Takes two to three times as long "
        "as Preview; raise Supersampling to 5 for detail far below a pixel"
    ): (
        "Am schärfsten, für Standbilder und für Bilder, die später verkleinert werden. Dauert zwei- bis "
        "dreimal so lange wie die Vorschau; für Details weit unter einem Pixel Supersampling auf 5 erhöhen"
    ),
    ("The sum of the splats' weights in each sample: 1/16 blue, 1/4 cyan, 1 green, 4 yellow, 16 and more red"): (
        "Die Summe der Gewichte der Splats in jedem Sample: 1/16 blau, 1/4 türkis, 1 grün, 4 gelb, 16 und mehr rot"
    ),
    (
        "The surfels' own colour without any light, as a scan captured it; Ambient Occlusion darkens it, and lights "
        "add diffuse light"
    ): (
        "Die Farbe der Surfels selbst ohne Licht, wie ein Scan sie aufgenommen hat; Umgebungsverdeckung dunkelt sie "
        "ab, und Lampen fügen diffuses Licht hinzu"
    ),
    (
        "The surfels' own colour, multiplied by a ramp's colour for the amount of diffuse light (Botsch et al. "
        "2005, section 6)"
    ): (
        "Die eigene Farbe der Surfels, multipliziert mit der Farbe eines Verlaufs für die Menge des diffusen Lichts "
        "(Botsch et al. 2005, section 6)"
    ),
    (
        "The surfels' own colour, multiplied by an image of a ball, looked up where the ball faces the same way "
        "(Sloan et al. 2001)"
    ): (
        "Die eigene Farbe der Surfels, multipliziert mit dem Bild einer Kugel, nachgeschlagen, wo die Kugel in "
        "dieselbe Richtung zeigt (Sloan et al. 2001)"
    ),
    "The surfels' own colour, unlit": ("Die Farbe der Surfels selbst, unbeleuchtet"),
    (
        "Uses the paper's own formulas: discs that face the ray vanish, and small ones lose their depth "
        "(Guennebaud et al. 2006, sections 3 and 4, equations 8 to 10)"
    ): (
        "Verwendet die Formeln des Artikels: Dem Strahl zugewandte Scheiben verschwinden, und kleine "
        "verlieren ihre Tiefe (Guennebaud et al. 2006, Abschnitte 3 und 4, Gleichungen 8 bis 10)"
    ),
    (
        "Uses the paper's own formulas: splats have half their size, and wrong depths where they are tilted "
        "(Botsch and Kobbelt 2003, equations 1 and 4 as printed)"
    ): (
        "Verwendet die Formeln des Artikels: Splats haben die halbe Größe und, wo sie geneigt sind, falsche Tiefen "
        "(Botsch und Kobbelt 2003, Gleichungen 1 und 4 wie gedruckt)"
    ),
    "Weight": "Gewicht",
}
