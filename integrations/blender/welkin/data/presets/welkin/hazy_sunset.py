import bpy

sky = bpy.context.scene.welkin
sky.sun_from = 'ANGLES'
sky.visibility = 25.0
sky.altitude = 0.0
sky.moon = False
sky.sun_elevation = 0.017453
sky.exposure = 0.91
