import bpy

sky = bpy.context.scene.welkin
sky.sun_from = 'ANGLES'
sky.visibility = 59.4
sky.altitude = 0.0
sky.moon = False
sky.sun_elevation = 1.047198
sky.exposure = -5.59
