"""The part that knows nothing of Blender: conditions, sources of light, the map, the air."""
