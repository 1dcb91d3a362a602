//! Light over a ground of any albedo from the light over two grounds.

use super::albedo::Albedo;

/// What light that left a ground of albedo 1 once is multiplied with: A / (1 − A s), `spherical` being the share of the
/// light from the ground that returns to it.
pub(crate) fn reflected(albedo: f64, spherical: f64) -> f64 {
    albedo / (1.0 - albedo * spherical)
}

/// At a wavelength the light over a ground is linear in A / (1 − A s), so two grounds make all others. The first has the
/// albedo of each node, the second is as far from that as can be. Format specification, section 7.2.
///
/// Between the nodes nothing else will do: what lies there is made of nodes some way off (section 7.3), over the
/// ground of the wavelength that is asked for and not over theirs.
#[derive(Clone, Debug)]
pub(crate) struct BetweenGrounds {
    albedo: Albedo,
    /// Of each node.
    spherical: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl BetweenGrounds {
    /// At nodes (nm) of these spherical albedos.
    pub fn new(albedo: &Albedo, nodes: &[f64], spherical: Vec<f64>) -> Self {
        let first: Vec<f64> = nodes.iter().map(|&l| albedo.at(l)).collect();
        let second = first.iter().map(|&a| if a < 0.5 { 1.0 } else { 0.0 });
        Self {
            second: second.collect(),
            first,
            spherical,
            albedo: albedo.clone(),
        }
    }

    pub fn albedo(&self) -> &Albedo {
        &self.albedo
    }

    /// Albedos of the second ground at the nodes.
    pub fn second(&self) -> &[f64] {
        &self.second
    }

    /// What the second ground counts at each node, for light at a wavelength; the first counts the rest.
    #[inline]
    pub fn shares(&self, wavelength: f64) -> impl Iterator<Item = f32> + '_ {
        let albedo = self.albedo.at(wavelength);
        let nodes = self.spherical.iter().zip(&self.first).zip(&self.second);
        nodes.map(move |((&s, &first), &second)| {
            let [first, second] = [first, second].map(|a| reflected(a, s));
            ((reflected(albedo, s) - first) / (second - first)) as f32
        })
    }

    /// Light at the nodes (`first`, over the first ground) as it is over the ground of a wavelength.
    #[inline]
    pub fn blend(&self, wavelength: f64, first: &mut [f32], second: &[f32]) {
        let lights = first.iter_mut().zip(second);
        for ((first, second), share) in lights.zip(self.shares(wavelength)) {
            *first = (*first + share * (second - *first)).max(0.0);
        }
    }

    pub fn nodes(&self) -> usize {
        self.first.len()
    }

    pub fn bytes(&self) -> usize {
        3 * size_of_val(self.spherical.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Any albedo at the nodes, any at the wavelength: what is blended is what the formula gives.
    #[test]
    fn two_grounds_make_all_others() {
        let nodes = [400.0, 500.0, 600.0, 700.0];
        let spherical = [0.3, 0.15, 0.05, 0.0];
        let light = |a: f64, n: usize| 1.0 + 0.7 * reflected(a, spherical[n]);
        for shares in [[0.0, 0.2, 0.49, 0.5], [0.51, 0.9, 1.0, 0.0]] {
            let albedo = Albedo::table(&nodes, &shares).unwrap();
            let grounds = BetweenGrounds::new(&albedo, &nodes, spherical.to_vec());
            for wavelength in [380.0, 430.0, 512.3, 600.0, 655.0, 800.0] {
                let of = |a: &dyn Fn(usize) -> f64| -> Vec<f32> {
                    (0..4).map(|n| light(a(n), n) as f32).collect()
                };
                let mut got = of(&|n| albedo.at(nodes[n]));
                let second = of(&|n| grounds.second()[n]);
                grounds.blend(wavelength, &mut got, &second);
                let wanted = of(&|_| albedo.at(wavelength));
                for (got, wanted) in got.iter().zip(&wanted) {
                    assert!((got / wanted - 1.0).abs() < 1e-6, "{got} {wanted}");
                }
            }
        }
    }
}
