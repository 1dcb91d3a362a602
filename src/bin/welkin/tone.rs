//! From light to what a display shows: white balance, gamut, tone curve, transfer function.

/// How scene light becomes display light. All curves leave middle grey, 0.18 of white, where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Tone {
    /// In proportion, clipped at white.
    Linear,
    /// Hable 2010, Uncharted 2: Filmic Tonemapping for Real-time Rendering.
    Filmic,
    /// The Academy Color Encoding System's reference and output transforms for sRGB, as Hill fitted them in 2016.
    #[default]
    Aces,
}

/// Linear sRGB to the space in which the curve of ACES is applied, and back.
const INTO_ACES: [[f32; 3]; 3] = [
    [0.597_19, 0.354_58, 0.048_23],
    [0.076_00, 0.908_34, 0.015_66],
    [0.028_40, 0.133_83, 0.837_77],
];
const FROM_ACES: [[f32; 3]; 3] = [
    [1.604_75, -0.531_08, -0.073_67],
    [-0.102_08, 1.108_13, -0.006_05],
    [-0.003_27, -0.072_76, 1.076_02],
];

/// Which light is white.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum WhiteBalance {
    /// Daylight film: CIE D55, adapted to the white of the display after Bradford. The sky is as blue as on
    /// photographs.
    #[default]
    Daylight,
    /// The white of the display, CIE D65: colours as they are measured, those of the EXR.
    D65,
}

/// Linear sRGB under D55 to linear sRGB under D65, after Bradford.
const DAYLIGHT: [[f32; 3]; 3] = [
    [0.963_048, -0.055_734, -0.010_05],
    [0.002_642, 1.013_428, -0.003_697],
    [0.004_656, 0.016_77, 1.188_038],
];

/// What makes a PNG of light.
#[derive(Clone, Copy, Debug)]
pub struct Film {
    /// Luminance of scene white, cd m⁻².
    pub white: f32,
    pub tone: Tone,
    pub balance: WhiteBalance,
}

impl Film {
    /// An sRGB pixel from a linear one, cd m⁻².
    pub fn display(&self, pixel: [f32; 3]) -> [u8; 3] {
        let scene = pixel.map(|v| v / self.white);
        let balanced = match self.balance {
            WhiteBalance::Daylight => multiply(&DAYLIGHT, scene),
            WhiteBalance::D65 => scene,
        };
        let shown = self.tone.apply(into_gamut(balanced));
        shown.map(|v| (encode_srgb(v.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8)
    }
}

impl Tone {
    /// Display light of scene light, both 0 to 1 from black to white; scene light may be above.
    fn apply(self, scene: [f32; 3]) -> [f32; 3] {
        // What is so bright is white.
        let scene = scene.map(|v| v.min(1e4));
        match self {
            Tone::Linear => scene,
            Tone::Filmic => scene.map(|v| filmic(FILMIC_SCALE * v)),
            Tone::Aces => {
                let exposed = multiply(&INTO_ACES, scene.map(|v| ACES_SCALE * v));
                multiply(&FROM_ACES, exposed.map(aces))
            }
        }
    }
}

/// What brings middle grey to middle grey.
const FILMIC_SCALE: f32 = 2.927_523;
const ACES_SCALE: f32 = 1.461_926;

/// Of linear sRGB: the weights of Rec. 709.
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn multiply(matrix: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Light of colours that sRGB does not have, with as much white as makes them possible, as bright as before.
fn into_gamut(rgb: [f32; 3]) -> [f32; 3] {
    let least = rgb.into_iter().fold(0.0, f32::min);
    if least == 0.0 {
        return rgb;
    }
    let luminance = luminance(rgb);
    if luminance <= 0.0 {
        return [0.0; 3];
    }
    let share = luminance / (luminance - least);
    rgb.map(|v| (luminance + share * (v - luminance)).max(0.0))
}

fn filmic(v: f32) -> f32 {
    const WHITE: f32 = 11.2;
    let curve =
        |x: f32| (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
    // Beyond white the curve has nothing to say.
    curve(v.min(WHITE)) / curve(WHITE)
}

fn aces(v: f32) -> f32 {
    (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081)
}

/// The transfer function of IEC 61966-2-1.
fn encode_srgb(v: f32) -> f32 {
    if v <= 0.003_130_8 {
        12.92 * v
    } else {
        1.055 * v.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Tone; 3] = [Tone::Linear, Tone::Filmic, Tone::Aces];

    fn film(tone: Tone) -> Film {
        Film {
            white: 1.0,
            tone,
            balance: WhiteBalance::D65,
        }
    }

    #[test]
    fn curves_are_monotone_from_black_to_white_through_middle_grey() {
        for tone in ALL {
            let grey = |v: f32| film(tone).display([v; 3])[1];
            assert!((0..2000).all(|i| grey(i as f32 * 0.01) <= grey((i + 1) as f32 * 0.01)));
            assert_eq!((grey(0.0), grey(1e30)), (0, 255), "{tone:?}");
            assert_eq!(grey(f32::MAX), 255);
            assert_eq!(grey(0.18), 118, "{tone:?}");
        }
    }

    /// Points that others publish.
    #[test]
    fn curves_are_the_published_ones() {
        // three.js, `ACESFilmicToneMapping`, and Hable's page: white is at 11.2.
        assert!((aces(0.18) - 0.105_6).abs() < 2e-3, "{}", aces(0.18));
        assert_eq!(filmic(11.2), 1.0);
    }

    #[test]
    fn colours_beyond_the_gamut_keep_their_luminance_and_hue() {
        let deep = [-0.05f32, 0.12, 0.6];
        let mapped = into_gamut(deep);
        assert!(mapped.iter().all(|&v| v >= 0.0));
        assert!((luminance(mapped) / luminance(deep) - 1.0).abs() < 1e-5);
        // Neither black nor purple.
        assert!(mapped[0] < mapped[1] && mapped[1] < mapped[2]);
        assert_eq!(into_gamut([0.1, 0.2, 0.3]), [0.1, 0.2, 0.3]);
        assert_eq!(into_gamut([-1.0, 0.0, 0.0]), [0.0; 3]);
        let daylight = |v| {
            Film {
                balance: WhiteBalance::Daylight,
                ..film(Tone::Linear)
            }
            .display(v)
        };
        // CIE D55 in linear sRGB under D65.
        assert!(
            daylight([0.5586, 0.4948, 0.4120])
                .iter()
                .all(|&v| v.abs_diff(188) < 2),
            "{:?}",
            daylight([0.5586, 0.4948, 0.4120])
        );
        for tone in ALL {
            let [r, g, b] = film(tone).display(deep);
            assert!(r <= g && g < b, "{tone:?} {r} {g} {b}");
        }
    }
}
