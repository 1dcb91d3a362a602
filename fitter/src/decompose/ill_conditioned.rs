//! Inputs that make decompositions by alternating least squares fail: swamps, degeneracy, noise, empty slices.

use super::coupled::{Cpd, Options, decompose};
use super::tucker::Dense;
use std::cell::RefCell;

const ALONE: [bool; 4] = [false; 4];

fn tensor(shape: [usize; 4], value: impl Fn([usize; 4]) -> f64) -> Dense {
    let [a, b, c, d] = shape;
    let cells = (0..a * b * c * d).map(|i| [i / (b * c * d), i / (c * d) % b, i / d % c, i % d]);
    Dense {
        shape,
        values: cells.map(value).collect(),
    }
}

fn options(rank: usize, sweeps: usize) -> Options {
    Options {
        rank,
        sweeps,
        seed: 3,
    }
}

fn fit(core: Dense, rank: usize, sweeps: usize) -> Cpd {
    decompose(&[core], ALONE, options(rank, sweeps), &|_, _| ())
}

fn value(cpd: &Cpd, index: [usize; 4]) -> f64 {
    let factors = &cpd.factors.0[0];
    let component = |r: usize| (0..4).map(|m| factors[m][(index[m], r)]).product::<f64>();
    (0..factors[0].ncols()).map(component).sum()
}

/// Sum of the norms of the components over the norm of the tensor.
fn condition(cpd: &Cpd, core: &Dense) -> f64 {
    let factors = &cpd.factors.0[0];
    let norm = core.values.iter().map(|v| v * v).sum::<f64>().sqrt();
    let component = |r: usize| factors.iter().map(|f| f.col(r).norm_l2()).product::<f64>();
    (0..factors[0].ncols()).map(component).sum::<f64>() / norm
}

/// Noise in −1..1 that is the same in every run.
fn noise(index: [usize; 4]) -> f64 {
    let [a, b, c, d] = index.map(|i| i as u64);
    let mut x = (((a * 97 + b) * 97 + c) * 97 + d).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (x >> 40) as f64 / (1u64 << 23) as f64 - 1.0
}

/// Components whose factors are nearly parallel in all modes: plain sweeps stall for thousands of rounds.
#[test]
fn swamps_are_crossed() {
    let factor = |i: usize, r: usize| 1.0 + 0.15 * ((i + 1) as f64 * (r + 1) as f64 * 0.7).sin();
    let component = |i: [usize; 4], r: usize| (0..4).map(|m| factor(i[m] + m, r)).product::<f64>();
    let core = tensor([8, 7, 6, 5], |i| (0..3).map(|r| component(i, r)).sum());
    let history = RefCell::new(vec![]);
    let tell = |_, rms| history.borrow_mut().push(rms);
    let cpd = decompose(&[core], ALONE, options(3, 1500), &tell);
    println!("{:?}", cpd.errors);
    assert!(cpd.errors[0] < 2e-4, "{:?}", cpd.errors);
    // What counts as a step never makes the fit worse, up to the ridge.
    let history = history.into_inner();
    assert!(history.windows(2).all(|w| w[1] < w[0] * 1.05 + 1e-4));
}

/// A tensor of rank 3 that two components approach without ever reaching it, while they grow and cancel: the ridge has
/// to stop them.
#[test]
fn components_that_cancel_do_not_run_away() {
    let (a, b) = ([1.0, 0.0, 0.5, 0.2], [0.0, 1.0, -0.3, 0.6]);
    let core = tensor([4, 4, 4, 2], |[i, j, k, _]| {
        a[i] * a[j] * b[k] + a[i] * b[j] * a[k] + b[i] * a[j] * a[k]
    });
    let again = tensor([4, 4, 4, 2], |i| {
        core.values[((i[0] * 4 + i[1]) * 4 + i[2]) * 2 + i[3]]
    });
    let cpd = fit(again, 2, 3000);
    let condition = condition(&cpd, &core);
    println!("condition {condition:.1}, error {:?}", cpd.errors);
    assert!((2.0..1000.0).contains(&condition), "{condition}");
    assert!(cpd.errors[0] < 0.05, "{:?}", cpd.errors);
}

/// White noise is left over, not fitted: the result is nearer to the truth than the data.
#[test]
fn noise_is_averaged_out() {
    let truth = |i: [usize; 4]| {
        let x = i.map(|v| v as f64);
        (1.0 + 0.3 * x[0]) * (2.0 - 0.2 * x[1]) * (0.4 * x[2]).cos() * (1.0 + x[3])
            + (0.5 * x[0]).sin() * (1.0 + x[1]) * (1.0 + 0.1 * x[2]) * (2.0 - 0.3 * x[3])
    };
    let shape = [10, 9, 8, 6];
    let clean = tensor(shape, truth);
    let rms = (clean.values.iter().map(|v| v * v).sum::<f64>() / clean.values.len() as f64).sqrt();
    let level = 0.01 * rms;
    let cpd = fit(tensor(shape, |i| truth(i) + level * noise(i)), 2, 300);
    let square = |i: [usize; 4]| (value(&cpd, i) - truth(i)).powi(2);
    let away = tensor(shape, square).values.iter().sum::<f64>() / clean.values.len() as f64;
    let ratio = away.sqrt() / (level / 3f64.sqrt());
    println!("left {:?}, {ratio:.2} of the noise in the fit", cpd.errors);
    assert!((0.004..0.0065).contains(&cpd.errors[0]), "{:?}", cpd.errors);
    assert!(ratio < 0.3, "{ratio}");
}

/// Slices of the night side hold next to nothing, one holds nothing at all: the fit stays finite and near zero there.
#[test]
fn empty_slices_stay_empty() {
    let day = |k: usize| match k {
        0 => 0.0,
        k => 10f64.powi(k as i32 - 9),
    };
    let truth = |i: [usize; 4]| {
        let x = i.map(|v| v as f64);
        day(i[2]) * (1.0 + 0.2 * x[0]) * (1.0 + (0.3 * x[1]).cos()) * (1.0 + 0.5 * x[3])
            + day(i[2]) * (0.3 * x[0]).sin() * (2.0 + x[1]) * (1.5 - 0.2 * x[3])
    };
    let shape = [7, 6, 10, 4];
    // More components than there are in the tensor.
    let cpd = fit(tensor(shape, truth), 5, 300);
    let factors = &cpd.factors.0[0];
    let finite = factors
        .iter()
        .all(|f| (0..f.ncols()).all(|r| f.col(r).iter().all(|v| v.is_finite())));
    assert!(finite && cpd.errors[0] < 1e-4, "{:?}", cpd.errors);
    let largest = |k: usize| {
        let values = tensor([7, 6, 1, 4], |i| value(&cpd, [i[0], i[1], k, i[3]])).values;
        values.iter().fold(0.0f64, |m, v| m.max(v.abs()))
    };
    assert!(largest(0) < 1e-6 * largest(9), "{}", largest(0));
    assert!(condition(&cpd, &tensor(shape, truth)) < 100.0);
}

/// Nothing at all can be decomposed too.
#[test]
fn an_empty_tensor_gives_empty_factors() {
    let cpd = fit(tensor([3, 3, 3, 3], |_| 0.0), 2, 20);
    let all = (0..81).map(|i| value(&cpd, [i / 27, i / 9 % 3, i / 3 % 3, i % 3]));
    assert!(all.into_iter().all(|v| v == 0.0));
}
