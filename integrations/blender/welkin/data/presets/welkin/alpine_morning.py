import bpy

sky = bpy.context.scene.welkin
sky.sun_from = 'ANGLES'
sky.visibility = 131.8
sky.altitude = 3000.0
sky.moon = False
sky.sun_elevation = 0.261799
sky.exposure = -3.67
