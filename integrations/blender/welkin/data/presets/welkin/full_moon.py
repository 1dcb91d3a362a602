import bpy

sky = bpy.context.scene.welkin
sky.sun_from = 'ANGLES'
sky.visibility = 59.4
sky.altitude = 0.0
sky.moon = True
sky.sun_elevation = -0.523599
sky.moon_elevation = 0.698132
sky.moon_phase = 0.027053
sky.exposure = 13.35
