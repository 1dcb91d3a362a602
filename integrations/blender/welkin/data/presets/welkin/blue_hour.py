import bpy

sky = bpy.context.scene.welkin
sky.sun_from = 'ANGLES'
sky.visibility = 59.4
sky.altitude = 0.0
sky.moon = False
sky.sun_elevation = -0.087266
sky.exposure = 7.92
