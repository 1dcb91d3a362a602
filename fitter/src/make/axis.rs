//! A number of a recipe as an axis of the model: the same air with more or less of something.
//!
//! The file keeps its axis of visibilities, and says what these stand for (format specification, section 6.11). What
//! does not change the visibility gets nominal ones.

use crate::air::Air;
use crate::atmosphere::{Atmosphere, Monochromatic};
use crate::recipe::Recipe;
use anyhow::{Context, Result, ensure};
use welkin::format::{AxisTable, Chunk, Payload};

/// Nominal visibilities of the largest and the least value, m: those of the default model.
const NOMINAL: [f64; 2] = [20e3, 131.8e3];
/// Visibilities whose inverses differ by less, relative, are no axis.
const APART: f64 = 1e-3;
/// Profiles and strengths of lines that differ by less, relative to the largest, are the same.
const SAME: f64 = 1e-6;
/// Where the nodes of an axis are compared, nm.
const GREEN: f64 = 550.0;
/// What is measured in which unit.
const UNITS: [(&str, &str); 3] = [("ozone", "DU"), ("humidity", "%"), ("extinction", "1/km")];
/// The parameter that the axis of visibilities itself is.
const VISIBILITY: &str = "visibility";

/// A number of a recipe and its values at the nodes of a model.
///
/// ```
/// use welkin_fitter::make::Axis;
/// use welkin_fitter::recipe::Recipe;
///
/// let average = Recipe::named("continental-average").unwrap();
/// let axis = Axis::parse(&average, "ozone=100,300,500")?;
/// // Nominal visibilities, as ozone does not change them: 1/V is linear in the column.
/// let inverse: Vec<f64> = axis.visibilities().iter().map(|v| 1.0 / v).collect();
/// assert!((inverse[0] - 2.0 * inverse[1] + inverse[2]).abs() < 1e-18);
/// assert!(Axis::parse(&average, "layers.mixing.top=1,2").is_err());
/// # Ok::<(), anyhow::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Axis {
    recipe: Recipe,
    parameter: String,
    /// By increasing visibility.
    nodes: Vec<Node>,
}

#[derive(Clone, Debug)]
struct Node {
    /// m.
    visibility: f64,
    value: f64,
    air: Recipe,
}

impl Axis {
    /// From `NAME=VALUE,VALUE,…`, values in any order.
    pub fn parse(recipe: &Recipe, text: &str) -> Result<Self> {
        let usage = || format!("--axis: expected NAME=VALUE,VALUE,…, got {text:?}");
        let (name, list) = text.split_once('=').with_context(usage)?;
        let number = |cell: &str| -> Result<f64> { cell.trim().parse().with_context(usage) };
        let values: Vec<f64> = list.split(',').map(number).collect::<Result<_>>()?;
        Self::new(recipe, name.trim(), values).with_context(|| format!("--axis {}", name.trim()))
    }

    /// At these values, in any order.
    pub fn new(recipe: &Recipe, parameter: &str, mut values: Vec<f64>) -> Result<Self> {
        ensure!(
            values.iter().all(|v| v.is_finite()),
            "a value is not finite"
        );
        values.sort_by(f64::total_cmp);
        values.dedup();
        ensure!(values.len() >= 2, "an axis needs two values or more");
        let with = |&value: &f64| recipe.with(parameter, value);
        let airs: Vec<Recipe> = values.iter().map(with).collect::<Result<_>>()?;
        check_common(&airs)?;
        check_amount(parameter, &airs, &values)?;
        let visibilities = visibilities(&airs, &values)?;
        let nodes = visibilities.into_iter().zip(values).zip(airs);
        let node = |((visibility, value), air)| Node {
            visibility,
            value,
            air,
        };
        let mut nodes: Vec<Node> = nodes.map(node).collect();
        nodes.sort_by(|a, b| a.visibility.total_cmp(&b.visibility));
        Ok(Self {
            recipe: recipe.clone(),
            parameter: parameter.to_owned(),
            nodes,
        })
    }

    /// Of the nodes, m, increasing.
    pub fn visibilities(&self) -> Vec<f64> {
        self.nodes.iter().map(|node| node.visibility).collect()
    }

    /// The air at the nodes.
    pub fn air(&self) -> Air {
        let node = |node: &Node| (node.visibility, node.air.clone());
        Air::Recipes(self.nodes.iter().map(node).collect())
    }

    /// What the file says of its nodes; nothing where these are visibilities.
    pub fn chunk(&self) -> Option<Chunk> {
        let table = AxisTable {
            name: self.parameter.clone(),
            unit: self.unit().to_owned(),
            values: self.nodes.iter().map(|node| node.value).collect(),
        };
        let is_other = self.parameter != VISIBILITY;
        is_other.then(|| Chunk::new(None, None, Payload::Axis(table)))
    }

    /// The air half way between each two nodes, and the visibility (m) that a reader asks for it.
    pub fn between(&self) -> Result<Vec<(f64, Air)>> {
        let middle = |pair: &[Node]| {
            let [a, b] = [&pair[0], &pair[1]];
            let visibility = 2.0 / (1.0 / a.visibility + 1.0 / b.visibility);
            let value = match self.parameter == VISIBILITY {
                true => visibility / 1e3,
                false => 0.5 * (a.value + b.value),
            };
            let air = self.recipe.with(&self.parameter, value)?;
            Ok((visibility, Air::Recipes(vec![(visibility, air)])))
        };
        self.nodes.windows(2).map(middle).collect()
    }

    fn unit(&self) -> &'static str {
        let last = self.parameter.rsplit('.').next().unwrap_or_default();
        let found = UNITS.iter().find(|(name, _)| *name == last);
        found.map_or("", |(_, unit)| unit)
    }
}

/// What a file keeps once must be the same at all nodes.
fn check_common(airs: &[Recipe]) -> Result<()> {
    let light = |air: &Recipe| air.solar_irradiance().map(|sun| sun.at(GREEN));
    for air in airs {
        ensure!(
            light(air)? == light(&airs[0])?,
            "changes the sun, which a file has once"
        );
    }
    let atmospheres: Vec<Atmosphere> = airs.iter().map(compared).collect::<Result<_>>()?;
    let (first, others) = (&atmospheres[0], &atmospheres[1..]);
    for other in others {
        ensure!(
            has_profiles(first, other),
            "changes at what height the air is, which a file has once: it can hold more and less of something, not the \
             same elsewhere, nor what is nowhere at a value"
        );
        ensure!(
            has_lines(first, other),
            "changes the absorption lines of gases, of which a file has one strength"
        );
    }
    Ok(())
}

/// The air for light beside lines and for light that water vapour and mixed gases absorb.
fn compared(air: &Recipe) -> Result<Atmosphere> {
    let beside = Monochromatic::beside_lines(GREEN);
    let in_lines = Monochromatic {
        water: 0.1,
        mixed: 0.1,
        ..beside
    };
    air.air(&[beside, in_lines])
}

fn has_profiles(a: &Atmosphere, b: &Atmosphere) -> bool {
    let pairs = a.constituents.iter().zip(&b.constituents);
    a.constituents.len() == b.constituents.len()
        && a.altitudes == b.altitudes
        && pairs
            .map(|(a, b)| (&a.profile, &b.profile))
            .all(|(a, b)| are_same(a, b))
}

fn has_lines(a: &Atmosphere, b: &Atmosphere) -> bool {
    let lines = |air: &Atmosphere| -> Vec<Vec<f64>> {
        let of = |extinction: &[f64]| extinction.chunks(2).map(|w| w[1] - w[0]).collect();
        air.constituents.iter().map(|c| of(&c.extinction)).collect()
    };
    lines(a).iter().zip(&lines(b)).all(|(a, b)| are_same(a, b))
}

fn are_same(a: &[f64], b: &[f64]) -> bool {
    let largest = a.iter().chain(b).fold(0.0, |m: f64, v| m.max(v.abs()));
    let pairs = a.iter().zip(b);
    a.len() == b.len()
        && pairs
            .into_iter()
            .all(|(a, b)| (a - b).abs() <= SAME * largest)
}

/// Between nodes 1/V is linear in the value, which a visibility is not: only that of all the air may be an axis.
fn check_amount(parameter: &str, airs: &[Recipe], values: &[f64]) -> Result<()> {
    let last = parameter.rsplit('.').next();
    if last != Some(VISIBILITY) {
        return Ok(());
    }
    for (air, value) in airs.iter().zip(values) {
        let is_own = (air.visibility()? / (1e3 * value) - 1.0).abs() < APART;
        ensure!(
            parameter == VISIBILITY && is_own,
            "is that of a layer, which is no amount: use layers.NAME.extinction"
        );
    }
    Ok(())
}

/// Those of the airs where these tell them apart; otherwise nominal ones, whose inverses are linear in the values.
fn visibilities(airs: &[Recipe], values: &[f64]) -> Result<Vec<f64>> {
    let own: Vec<f64> = airs.iter().map(Recipe::visibility).collect::<Result<_>>()?;
    let steps = || own.windows(2).map(|w| w[1] / w[0] - 1.0);
    if steps().all(|step| step > APART) || steps().all(|step| step < -APART) {
        return Ok(own);
    }
    let [least, most] = [values[0], values[values.len() - 1]];
    let [hazy, clear] = NOMINAL.map(f64::recip);
    let nominal = |value: &f64| {
        let share = (value - least) / (most - least);
        1.0 / (clear + share * (hazy - clear))
    };
    Ok(values.iter().map(nominal).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(recipe: &str, text: &str) -> Result<Axis> {
        Axis::parse(&Recipe::named(recipe).unwrap(), text)
    }

    fn table(axis: &Axis) -> AxisTable {
        match axis.chunk().unwrap().payload {
            Payload::Axis(table) => table,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_does_not_change_the_visibility_gets_nominal_ones() {
        let ozone = axis("continental-average", "ozone=500,100,300").unwrap();
        let ends = [ozone.visibilities()[0], ozone.visibilities()[2]];
        assert!(
            ends.iter()
                .zip(NOMINAL)
                .all(|(a, b)| (a / b - 1.0).abs() < 1e-12)
        );
        let AxisTable { name, unit, values } = table(&ozone);
        assert_eq!((name.as_str(), unit.as_str()), ("ozone", "DU"));
        assert_eq!(values, [500.0, 300.0, 100.0]);
    }

    #[test]
    fn amounts_of_particles_have_their_own_visibilities() {
        let depth = axis("continental-average", "optical_depth=0.05,0.1,0.2").unwrap();
        let Air::Recipes(nodes) = depth.air() else {
            panic!("no recipes");
        };
        for (visibility, air) in nodes {
            assert_eq!(visibility, air.visibility().unwrap());
        }
        assert_eq!(table(&depth).values, [0.2, 0.1, 0.05]);
        // Extinction is linear in the amount, and so is 1/V.
        for (visibility, air) in depth.between().unwrap() {
            let Air::Recipes(nodes) = air else {
                panic!("no recipes");
            };
            assert!((nodes[0].1.visibility().unwrap() / visibility - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_visibility_itself_needs_no_other_name() {
        let plain = axis("continental-average", "visibility=20,60").unwrap();
        assert!(plain.chunk().is_none());
        assert!((plain.visibilities()[1] / 60e3 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn what_a_file_has_once_is_no_axis() {
        let refusal = |recipe: &str, text: &str| format!("{:#}", axis(recipe, text).unwrap_err());
        let average = |text: &str| refusal("continental-average", text);
        assert!(average("sun_distance=0.98,1.02").contains("the sun"));
        assert!(average("pressure=800,1000").contains("lines"));
        assert!(average("water=1,2").contains("lines"));
        assert!(refusal("fog", "layers.fog.visibility=0.5,1").contains("extinction"));
        assert!(axis("fog", "visibility=0.5,1").is_ok());
        assert!(average("ozone=300").contains("two values"));
        assert!(average("ozone=300,300").contains("two values"));
        assert!(average("ozone=300,many").contains("NAME=VALUE"));
        assert!(average("ozone").contains("NAME=VALUE"));
        assert!(average("ozone=100,inf").contains("finite"));
        assert!(average("magic=1,2").contains("cannot be changed"));
    }
}
