//! The one place that chooses instructions: kernels compiled for wide vectors where the processor has them.
//!
//! Kernels do not reorder floating-point operations, and fuse them only where they ask for
//! [`add_product`](Instructions::add_product); where they do not, every path gives the same bits.

use zerocopy::little_endian::U16;

use crate::kernel::half::widen;
use crate::kernel::lanes::Lanes;

/// Work that is worth wide vectors. `run` must be `#[inline(always)]`.
pub(crate) trait Kernel {
    type Output;
    fn run<I: Instructions>(self, instructions: I) -> Self::Output;
}

/// What the compiler does not find by itself.
pub(crate) trait Instructions: Copy {
    /// Widens finite half-precision numbers.
    fn widen(self, halves: &[U16; 8]) -> Lanes<8>;
    /// `sum + a · b`, which a processor may round once instead of twice.
    fn add_product(self, sum: Lanes<8>, a: Lanes<8>, b: f32) -> Lanes<8>;
    /// Asks for numbers that will be read soon.
    fn fetch<T>(self, numbers: &[T]);
    /// Runs a kernel as a function of its own, which has all registers to itself.
    fn apart<K: Kernel>(self, kernel: K) -> K::Output;
}

/// For every processor.
#[derive(Clone, Copy)]
pub(crate) struct Portable;

impl Instructions for Portable {
    #[inline(always)]
    fn widen(self, halves: &[U16; 8]) -> Lanes<8> {
        let mut lanes = [0.0; 8];
        for i in 0..8 {
            lanes[i] = widen(halves[i]);
        }
        Lanes(lanes)
    }

    #[inline(always)]
    fn add_product(self, sum: Lanes<8>, a: Lanes<8>, b: f32) -> Lanes<8> {
        sum + a * b
    }

    #[inline(always)]
    fn fetch<T>(self, _: &[T]) {}

    #[inline(never)]
    fn apart<K: Kernel>(self, kernel: K) -> K::Output {
        kernel.run(self)
    }
}

/// Runs a kernel with the widest vectors of this processor.
#[inline]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    if let Some(instructions) = x86::Wide::detected() {
        return instructions.run(kernel);
    }
    kernel.run(Portable)
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
mod x86 {
    use core::arch::x86_64::{
        _MM_HINT_T1, _mm_prefetch, _mm_set_epi64x, _mm256_cvtph_ps, _mm256_fmadd_ps,
        _mm256_loadu_ps, _mm256_set1_ps, _mm256_storeu_ps,
    };

    use zerocopy::IntoBytes;
    use zerocopy::little_endian::U16;

    use super::{Instructions, Kernel, Lanes};

    /// AVX2, F16C and FMA. Exists only where the processor has all three.
    #[derive(Clone, Copy)]
    pub struct Wide(());

    impl Wide {
        #[inline]
        pub fn detected() -> Option<Self> {
            let detected = std::arch::is_x86_feature_detected!("avx2")
                && std::arch::is_x86_feature_detected!("f16c")
                && std::arch::is_x86_feature_detected!("fma");
            detected.then_some(Self(()))
        }

        #[inline]
        pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
            // SAFETY: `self` is the proof that the processor has the instructions.
            unsafe { run(self, kernel) }
        }
    }

    #[inline(never)]
    #[target_feature(enable = "avx2,f16c,fma")]
    fn run<K: Kernel>(wide: Wide, kernel: K) -> K::Output {
        kernel.run(wide)
    }

    impl Instructions for Wide {
        #[inline(always)]
        fn widen(self, halves: &[U16; 8]) -> Lanes<8> {
            let (low, high) = halves.split_at(4);
            let bits = |half: &[U16]| {
                let bytes = half.as_bytes().first_chunk();
                i64::from_le_bytes(bytes.copied().unwrap_or_default())
            };
            let mut lanes = Lanes::splat(0.0);
            // SAFETY: `self` is the proof that the processor has F16C, and with it AVX; `lanes` has room for eight
            // numbers, and the store asks for no alignment.
            unsafe {
                let packed = _mm_set_epi64x(bits(high), bits(low));
                _mm256_storeu_ps(lanes.0.as_mut_ptr(), _mm256_cvtph_ps(packed));
            }
            lanes
        }

        #[inline(always)]
        fn add_product(self, sum: Lanes<8>, a: Lanes<8>, b: f32) -> Lanes<8> {
            let mut lanes = sum;
            // SAFETY: `self` is the proof that the processor has FMA, and with it AVX; loads and the store are within
            // arrays of eight numbers and ask for no alignment.
            unsafe {
                let product = [a.0.as_ptr(), sum.0.as_ptr()].map(|p| _mm256_loadu_ps(p));
                let value = _mm256_fmadd_ps(product[0], _mm256_set1_ps(b), product[1]);
                _mm256_storeu_ps(lanes.0.as_mut_ptr(), value);
            }
            lanes
        }

        #[inline(always)]
        fn fetch<T>(self, numbers: &[T]) {
            const LINE: usize = 64;
            let first = numbers.as_ptr().cast::<i8>();
            for place in (0..size_of_val(numbers)).step_by(LINE) {
                // SAFETY: the address is in the slice, and prefetching is a hint that never faults.
                unsafe { _mm_prefetch::<_MM_HINT_T1>(first.add(place)) };
            }
        }

        #[inline(always)]
        fn apart<K: Kernel>(self, kernel: K) -> K::Output {
            self.run(kernel)
        }
    }

    #[cfg(test)]
    mod tests {
        use super::super::Portable;
        use super::*;

        #[test]
        fn both_widen_alike() {
            let Some(wide) = Wide::detected() else { return };
            let finite = (0..=u16::MAX)
                .filter(|h| h & 0x7c00 != 0x7c00)
                .collect::<Vec<_>>();
            for halves in finite.as_chunks::<8>().0 {
                let halves = halves.map(U16::new);
                let bits = |lanes: Lanes<8>| lanes.0.map(f32::to_bits);
                assert_eq!(bits(wide.widen(&halves)), bits(Portable.widen(&halves)));
            }
        }
    }
}
