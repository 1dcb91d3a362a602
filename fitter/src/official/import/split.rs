//! Parts of the radiance: lobes around the sun with smooth factors, and the rest.
//!
//! A file knows only their sum. What is sharp around the sun moves with it, which factors over fixed directions follow
//! badly; lobes that phase functions make move by themselves. Their factors are found as polynomials over view and sun,
//! so that they are as smooth as possible.

use super::sites::Sites;
use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use rayon::prelude::*;
use std::ops::Range;

/// Asymmetries of the lobes.
pub const LOBES: [f64; 3] = [0.5, 0.75, 0.92];
/// Fields of light that did not come from the ground: the rest, and the lobes.
pub const AIR_FIELDS: usize = 1 + LOBES.len();

/// Terms of the polynomials of the rest: over solar elevation, view and azimuth.
const REST: [usize; 3] = [7, 8, 4];
/// Terms of those of a lobe: over solar elevation and view.
const LOBE: [usize; 2] = [5, 6];
/// Large enough that lobes and rest do not cancel: a sum of small numbers is what can be decomposed.
const RIDGE: f64 = 1e-5;
/// One in so many sites is fitted.
const STRIDE: usize = 3;
/// Radiance below this share of the mean counts less.
const DARK: f64 = 1e-3;

/// Henyey-Greenstein phase function of mean 1.
pub fn henyey_greenstein(g: f64, cosine: f64) -> f64 {
    let x = 1.0 + g * g - 2.0 * g * cosine;
    (1.0 - g * g) / (x * x.sqrt())
}

/// Splits the radiance of a channel, given by site, into the fields of [`AIR_FIELDS`], `[field][site]`; on sides where
/// nothing is seen all are 0.
pub struct Splitter {
    sides: Vec<Half>,
    sites: usize,
    cosines: Vec<f32>,
}

/// The sites of one side of the horizon.
struct Half {
    range: Range<usize>,
    /// The sites that the polynomials are fitted to, counted from the first of the range.
    fitted: Vec<usize>,
    /// Of these sites.
    terms: Mat<f64>,
    /// Of all.
    lobe_terms: Mat<f64>,
}

impl Splitter {
    /// For the sites of one altitude; `down` says whether the air below the horizon is seen.
    pub fn new(sites: &Sites, sun_coordinate: &[f64], down: bool) -> Self {
        let [views, azimuths, suns] = sites.shape();
        let cosines = sites.cosines();
        let lower = down.then_some(sites.up..views);
        let halves = std::iter::once(0..sites.up).chain(lower);
        let half = |views: Range<usize>| {
            let count = views.len() * azimuths * suns;
            // Others for each view and azimuth, whatever the number of suns.
            let fitted: Vec<usize> = (0..count)
                .filter(|i| (i + i / suns) % STRIDE == 0)
                .collect();
            let lobe_terms = lobe_terms(sites, sun_coordinate, views.clone());
            let first = views.start * azimuths * suns;
            let part = (
                fitted.as_slice(),
                &cosines[first..first + count],
                &lobe_terms,
            );
            Half {
                range: first..first + count,
                terms: terms(sites, sun_coordinate, views.len(), part),
                fitted,
                lobe_terms,
            }
        };
        Self {
            sides: halves.map(half).collect(),
            sites: views * azimuths * suns,
            cosines,
        }
    }

    /// The fields of every channel, `[channel][field][site]`, from its radiance by site.
    pub fn split_all(&self, channels: &[Vec<f64>]) -> Vec<Vec<Vec<f32>>> {
        channels.par_iter().map(|c| self.split(c)).collect()
    }

    fn split(&self, radiance: &[f64]) -> Vec<Vec<f32>> {
        let mut fields = vec![vec![0.0; self.sites]; AIR_FIELDS];
        for half in &self.sides {
            let part = &radiance[half.range.clone()];
            let lobes = half.lobes(part);
            for (i, site) in half.range.clone().enumerate() {
                let cosine = f64::from(self.cosines[site]);
                let mut rest = part[i];
                for (l, g) in LOBES.iter().enumerate() {
                    let lobe = lobes[(i, l)];
                    rest -= lobe * henyey_greenstein(*g, cosine);
                    fields[1 + l][site] = lobe as f32;
                }
                fields[0][site] = rest as f32;
            }
        }
        fields
    }
}

impl Half {
    /// Factors of the lobes by site.
    fn lobes(&self, radiance: &[f64]) -> Mat<f64> {
        let mean = radiance.iter().sum::<f64>() / radiance.len() as f64;
        let dark = (DARK * mean).max(1e-30);
        let weight = |i: usize| 1.0 / radiance[self.fitted[i]].max(dark);
        let (rows, columns) = (self.terms.nrows(), self.terms.ncols());
        let weighted = Mat::from_fn(rows, columns, |i, j| weight(i) * self.terms[(i, j)]);
        let target = Mat::from_fn(rows, 1, |i, _| weight(i) * radiance[self.fitted[i]]);
        let mut normal = weighted.transpose() * &weighted;
        let right = weighted.transpose() * &target;
        let trace = (0..columns).map(|i| normal[(i, i)]).sum::<f64>() / columns as f64;
        for i in 0..columns {
            normal[(i, i)] += RIDGE * trace + 1e-30;
        }
        let solution = match Llt::new(normal.as_ref(), Side::Lower) {
            Ok(llt) => llt.solve(&right),
            // No lobes: the rest is all there is.
            Err(_) => Mat::zeros(columns, 1),
        };
        let own = self.lobe_terms.ncols();
        let first = columns - LOBES.len() * own;
        let factors = Mat::from_fn(own, LOBES.len(), |i, l| solution[(first + l * own + i, 0)]);
        &self.lobe_terms * factors
    }
}

/// Terms of the rest, then those of each lobe times its phase function, at some sites.
fn terms(
    sites: &Sites,
    sun: &[f64],
    views: usize,
    (fitted, cosines, lobe): (&[usize], &[f32], &Mat<f64>),
) -> Mat<f64> {
    let [_, azimuths, suns] = sites.shape();
    let rest = REST.iter().product::<usize>();
    let over_view = chebyshev(&spread(views), REST[1]);
    let over_sun = chebyshev(sun, REST[0]);
    let over_azimuth: Vec<f64> = sites.azimuths.iter().map(|p| p.cos()).collect();
    let over_azimuth = chebyshev(&over_azimuth, REST[2]);
    Mat::from_fn(fitted.len(), rest + LOBES.len() * lobe.ncols(), |row, j| {
        let i = fitted[row];
        let (v, p, e) = (i / (azimuths * suns), i / suns % azimuths, i % suns);
        if j < rest {
            let (a, b, c) = (j / (REST[1] * REST[2]), j / REST[2] % REST[1], j % REST[2]);
            return over_sun[e][a] * over_view[v][b] * over_azimuth[p][c];
        }
        let (l, t) = ((j - rest) / lobe.ncols(), (j - rest) % lobe.ncols());
        lobe[(i, t)] * henyey_greenstein(LOBES[l], f64::from(cosines[i]))
    })
}

fn lobe_terms(sites: &Sites, sun: &[f64], views: Range<usize>) -> Mat<f64> {
    let [_, azimuths, suns] = sites.shape();
    let over_view = chebyshev(&spread(views.len()), LOBE[1]);
    let over_sun = chebyshev(sun, LOBE[0]);
    Mat::from_fn(views.len() * azimuths * suns, LOBE[0] * LOBE[1], |i, j| {
        over_sun[i % suns][j / LOBE[1]] * over_view[i / (azimuths * suns)][j % LOBE[1]]
    })
}

/// Points at even distances over −1..=1.
fn spread(count: usize) -> Vec<f64> {
    let last = (count - 1).max(1) as f64;
    (0..count).map(|i| 2.0 * i as f64 / last - 1.0).collect()
}

/// Chebyshev polynomials at points in −1..=1, `[point][order]`.
fn chebyshev(points: &[f64], count: usize) -> Vec<Vec<f64>> {
    let angles = points.iter().map(|x| x.clamp(-1.0, 1.0).acos());
    let row = |angle: f64| (0..count).map(|n| (n as f64 * angle).cos()).collect();
    angles.map(row).collect()
}
