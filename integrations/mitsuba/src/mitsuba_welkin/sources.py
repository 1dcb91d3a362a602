"""What welkin knows of a scene, as arrays: the tables of the sky, its density, the disc of the sun."""

import math

import mitsuba as mi
import numpy as np
import welkin_sky

# Of the disc, rad: half of 0.533 degrees.
SOLAR_ANGULAR_RADIUS = 0.004654793
# Mitsuba's RGB of a spectrum is its XYZ over the luminous efficacy and over the integral of the luminous efficiency, nm.
EFFICACY = 683.002
Y_INTEGRAL = 106.7502593994140625

# Wavelengths at which spectral variants know the sky, nm.
FIRST, STEP, COUNT = 360.0, 10.0, 48

# Rows and columns of the density from which directions are drawn, and of a disc.
ROWS, COLUMNS = 129, 257
DISC = 17

_bands = {}
MOST_BANDS = 4


def bands_of(model, key):
    """Triangles of 20 nm about each wavelength, fitted once for each model and phase of the moon; the last few are kept."""
    if key not in _bands:
        while len(_bands) >= MOST_BANDS:
            del _bands[next(iter(_bands))]
        centres = FIRST + STEP * np.arange(COUNT)
        triangle = [0.0, 1.0, 0.0]
        responses = [
            welkin_sky.Response.table([l - STEP, l, l + STEP], triangle).normalised() for l in centres]
        _bands[key] = model.bands(responses)
    return _bands[key]


class Sources:
    """Prepares a scene: which arrays are made depends on the variant of Mitsuba."""

    def __init__(self, model, key, conditions):
        self.model, self.key, self.conditions = model, key, conditions
        self.colour = model.colour_sky(conditions).bake()
        spectral, polarised = mi.is_spectral, mi.is_polarized
        self.disc = model.solar_disc(conditions)
        if spectral or polarised:
            bands = bands_of(model, key)
            sky = model.polarised_band_sky if polarised else model.band_sky
            sky = sky(bands, conditions)
            self.buffers = sky.buffers() if polarised else sky.bake().buffers()
            self.band_disc = model.band_solar_disc(bands, conditions)
        else:
            self.buffers = self.colour.buffers()

    def density(self):
        """Luminance on a lattice of azimuths from the sun (columns) and heights (rows), times solid angle."""
        turn = 2.0 * math.pi * (np.arange(COLUMNS) / (COLUMNS - 1) - 0.5)
        share = 2.0 * np.arange(ROWS) / (ROWS - 1) - 1.0
        z = share * np.abs(share)
        azimuth = self.conditions.solar_azimuth + turn
        flat = np.sqrt(1.0 - z * z)[:, None]
        z = np.broadcast_to(z[:, None], (ROWS, COLUMNS))
        directions = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), z], -1).astype(np.float32)
        luminance = self.colour.xyz(directions)[..., 1]
        # Some density everywhere that light may come from, as the sky changes between the nodes of the lattice.
        luminance = np.maximum(luminance, 1e-3 * luminance.max())
        return (luminance * np.abs(share)[:, None]).astype(np.float32)

    def sky_luminous_flux(self):
        """Luminance of the sky over all directions, cd m⁻² sr."""
        density = self.density()
        cells = 0.25 * (density[1:, 1:] + density[:-1, 1:] + density[1:, :-1] + density[:-1, :-1])
        # dz = 4 |share| dv with v from 0 to 1.
        return float(cells.mean() * 4.0 * 2.0 * math.pi)

    def disc_lattice(self):
        """Radiance on a lattice over the square around the disc: (channels, rows, columns); (…, 3) for colours."""
        d = np.asarray(self.disc.direction, np.float64)
        side = np.cross([0.0, 0.0, 1.0], d)
        norm = np.linalg.norm(side)
        side = side / norm if norm > 1e-6 else np.array([0.0, 1.0, 0.0])
        up = np.cross(d, side)
        places = np.linspace(-1.0, 1.0, DISC)
        x, y = np.meshgrid(places, places)
        # Beyond the limb the value at the limb goes on, so that interpolation near it is right.
        radius = np.maximum(np.hypot(x, y) / 0.998, 1.0)
        tangent = math.tan(SOLAR_ANGULAR_RADIUS)
        offset = tangent * ((x / radius)[..., None] * side + (y / radius)[..., None] * up)
        directions = (d + offset).astype(np.float32)
        if mi.is_spectral or mi.is_polarized:
            values = self.band_disc.radiance(directions)
        else:
            values = self.disc.xyz(directions)
        return np.moveaxis(np.asarray(values), -1, 0), side, up

    def disc_luminous_flux(self):
        """Illuminance by the disc, of a plane that faces it, lx: about, as the limb is darker."""
        if not self.disc.is_visible:
            return 0.0
        centre = float(self.disc.xyz(np.asarray(self.disc.direction, np.float32))[1])
        return 0.8 * centre * float(self.disc.solid_angle)
