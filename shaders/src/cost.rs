//! What a function costs, counted in SPIR-V.

use std::collections::BTreeMap;
use std::ops::AddAssign;

/// Operations and reads of a function with what it calls: components of vectors count one by one, both sides of a branch
/// count, and the body of a loop counts once.
///
/// ```
/// use welkin_shaders::{PROGRAMS, cost, translations};
///
/// let sky = &cost(&translations(&PROGRAMS[0])?.spirv)["sky_group"];
/// assert!(sky.table_bytes == 16 * (4 + 16 + 1) && sky.roots_and_powers >= 4);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Sums, products, quotients, minima and the like in floating point.
    pub floating: u32,
    /// Roots, powers and logarithms.
    pub roots_and_powers: u32,
    /// Of integers, comparisons, choices, conversions.
    pub other: u32,
    /// Bytes read from storage buffers.
    pub table_bytes: u32,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.floating += other.floating;
        self.roots_and_powers += other.roots_and_powers;
        self.other += other.other;
        self.table_bytes += other.table_bytes;
    }
}

/// What is known of the numbers of a module.
#[derive(Default)]
struct Ids {
    names: BTreeMap<u32, String>,
    /// Components of types.
    widths: BTreeMap<u32, u32>,
    /// Pointers into storage buffers.
    stored: Vec<u32>,
    types: BTreeMap<u32, u32>,
}

/// Functions by name.
pub fn cost(spirv: &[u32]) -> BTreeMap<String, Cost> {
    let (mut ids, mut own) = (Ids::default(), BTreeMap::<u32, (Cost, Vec<u32>)>::new());
    let (mut rest, mut function) = (&spirv[5..], 0);
    while let [head, ..] = rest {
        let (instruction, after) = rest.split_at((head >> 16) as usize);
        rest = after;
        let (code, words) = (head & 0xffff, &instruction[1..]);
        match code {
            5 => drop(ids.names.insert(words[0], text(&words[1..]))), // OpName
            21 | 22 => drop(ids.widths.insert(words[0], 1)),          // OpTypeInt, OpTypeFloat
            23 => drop(ids.widths.insert(words[0], words[2])),        // OpTypeVector
            54 => function = words[1],                                // OpFunction
            57 => own.entry(function).or_default().1.push(words[2]),  // OpFunctionCall
            _ => own.entry(function).or_default().0 += ids.instruction(code, words),
        }
        if words.len() > 1 {
            ids.types.insert(words[1], words[0]);
        }
    }
    let named = own
        .keys()
        .filter_map(|id| Some((ids.names.get(id)?.clone(), total(&own, *id))));
    named.collect()
}

fn total(own: &BTreeMap<u32, (Cost, Vec<u32>)>, id: u32) -> Cost {
    let Some((mut cost, calls)) = own.get(&id).cloned() else {
        return Cost::default();
    };
    for call in calls {
        cost += total(own, call);
    }
    cost
}

impl Ids {
    fn instruction(&mut self, code: u32, words: &[u32]) -> Cost {
        let mut cost = Cost::default();
        let width = words
            .first()
            .and_then(|t| self.widths.get(t))
            .copied()
            .unwrap_or(0);
        match code {
            // OpVariable in a storage buffer, OpAccessChain into one.
            59 if words[2] == 12 => self.stored.push(words[1]),
            65 if self.stored.contains(&words[2]) => self.stored.push(words[1]),
            61 if self.stored.contains(&words[2]) => cost.table_bytes = 4 * width, // OpLoad
            127 | 129 | 131 | 133 | 136 | 141 | 142 => cost.floating = width,
            // OpDot: as many products as components, and sums between them.
            148 => {
                let operand = self.types.get(&words[2]).and_then(|t| self.widths.get(t));
                cost.floating = (2 * operand.copied().unwrap_or(1)).saturating_sub(1);
            }
            12 => self.extended(words[3], width, &mut cost),
            // Conversions, integers, comparisons, choices.
            109..=112 | 124 | 126 | 128 | 130 | 132 | 134 | 135 | 137..=139 | 164..=200 => {
                cost.other = width.max(1);
            }
            _ => {}
        }
        cost
    }

    /// Of GLSL.std.450.
    fn extended(&self, number: u32, width: u32, cost: &mut Cost) {
        match number {
            // Trigonometry, powers, exponentials, logarithms, roots.
            13..=32 => cost.roots_and_powers = width,
            // Length and distance, normalisation.
            66 | 67 | 69 => (cost.floating, cost.roots_and_powers) = (6, 1),
            // A clamp is two.
            43 => cost.floating = 2 * width,
            _ => cost.floating = width,
        }
    }
}

fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|w| w.to_le_bytes());
    String::from_utf8_lossy(&bytes.take_while(|&b| b != 0).collect::<Vec<_>>()).into_owned()
}
