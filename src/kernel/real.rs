//! Elementary functions where there is no standard library.

/// The methods of the standard library that are used, from `libm`.
pub(crate) trait Real: Sized {
    fn sqrt(self) -> Self;
    fn cbrt(self) -> Self;
    fn powf(self, exponent: Self) -> Self;
    fn powi(self, exponent: i32) -> Self;
    fn sin(self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn atan(self) -> Self;
    fn atan2(self, x: Self) -> Self;
    fn sinh(self) -> Self;
    fn ln(self) -> Self;
    fn exp(self) -> Self;
}

macro_rules! real {
    ($type:ty, $sqrt:path, $cbrt:path, $pow:path, $sin:path, $cos:path, $atan:path, $atan2:path, $sinh:path, $ln:path, $exp:path) => {
        impl Real for $type {
            #[inline]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            fn cbrt(self) -> Self {
                $cbrt(self)
            }
            fn powf(self, exponent: Self) -> Self {
                $pow(self, exponent)
            }
            fn powi(self, exponent: i32) -> Self {
                $pow(self, exponent as Self)
            }
            fn sin(self) -> Self {
                $sin(self)
            }
            fn sin_cos(self) -> (Self, Self) {
                ($sin(self), $cos(self))
            }
            fn atan(self) -> Self {
                $atan(self)
            }
            fn atan2(self, x: Self) -> Self {
                $atan2(self, x)
            }
            fn sinh(self) -> Self {
                $sinh(self)
            }
            fn ln(self) -> Self {
                $ln(self)
            }
            fn exp(self) -> Self {
                $exp(self)
            }
        }
    };
}

real!(
    f64,
    libm::sqrt,
    libm::cbrt,
    libm::pow,
    libm::sin,
    libm::cos,
    libm::atan,
    libm::atan2,
    libm::sinh,
    libm::log,
    libm::exp
);
real!(
    f32,
    libm::sqrtf,
    libm::cbrtf,
    libm::powf,
    libm::sinf,
    libm::cosf,
    libm::atanf,
    libm::atan2f,
    libm::sinhf,
    libm::logf,
    libm::expf
);
