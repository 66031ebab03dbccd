# SPDX-License-Identifier: GPL-3.0-or-later
"""What one object or one light has: its panels and its style."""

TEXTS = {
    "Angle": "Winkel",
    "Beam Shape": "Strahlform",
    "Blend": "Mischung",
    "Draw lines of a width and a color of their own": "Linien in eigener Breite und Farbe zeichnen",
    "Draw no lines": "Keine Linien zeichnen",
    "Draw the lines that its materials say": "Die Linien zeichnen, die seine Materialien angeben",
    "Draw the lines that the render properties say": "Die Linien zeichnen, die die Render-Eigenschaften angeben",
    "From Materials": "Aus Materialien",
    "Glossy": "Glänzend",
    "How the amount of light becomes a color": "Wie aus der Lichtmenge eine Farbe wird",
    "Its Emission node's colour and strength scale the light": (
        "Farbe und Stärke der Emission-Node skalieren das Licht"
    ),
    "Levels of brightness": "Helligkeitsstufen",
    "Look up the light in the color ramp of a texture": "Das Licht im Farbverlauf einer Textur nachschlagen",
    "Nodes": "Nodes",
    "Own": "Eigene",
    "Ray Visibility": "Strahlensichtbarkeit",
    "Scan Colors": "Scan-Farben",
    "Shade it as its materials say": "Schattieren, wie es seine Materialien angeben",
    "Shade it as the render properties say, or by the ramp that its nodes have": (
        "Schattieren, wie es die Render-Eigenschaften angeben, oder mit dem Farbverlauf seiner Nodes"
    ),
    "Shared by all lights": "Für alle Lichter gemeinsam",
    "Show the light in even steps": "Das Licht in gleichmäßigen Stufen zeigen",
    "Temperature": "Temperatur",
    (
        "Texture whose color ramp is looked up by the amount of light, from none at the left to full light at the"
        " right. Without a texture, three even greys are used"
    ): (
        "Textur, in deren Farbverlauf die Lichtmenge nachgeschlagen wird, von keinem Licht links bis zu vollem "
        "Licht rechts. Ohne Textur sind es drei gleichmäßige Grautöne"
    ),
    "The lines along its silhouettes and creases": "Die Linien entlang der Umrisse und Knicke",
    "Tint": "Tönung",
    "Toon and Lines": "Toon und Linien",
    "Width of the lines": "Breite der Linien",
}
