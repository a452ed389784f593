"""A scene: body, start, support and excitation at the reference size, stated for every engine."""
