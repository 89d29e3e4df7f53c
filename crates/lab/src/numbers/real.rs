//! Numbers that a formula can be written in once: f32, f64, and packets of either.

use core::ops::{Add, Div, Mul, Neg, Sub};
use luc_core::math::lanes::{self, Bound, F};
use luc_core::math::lanes_f64::{D, splat_d};
use luc_core::math::lanes_fn;

/// A function of one or two numbers as the platform has it.
pub struct Function {
    pub narrow: fn(f32, f32) -> f32,
    pub wide: fn(f64, f64) -> f64,
}

/// What the naive formulas need.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A number in all lanes.
    fn of(v: f64) -> Self;
    fn sqrt(self) -> Self;
    fn exp(self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn floor(self) -> Self;
    /// The lesser of two; the other one where `self` is NaN.
    fn min(self, b: Self) -> Self;
    fn max(self, b: Self) -> Self;
    /// A function of the platform, lane by lane.
    fn each(f: &Function, x: Self, y: Self) -> Self;
    /// `a` where this is 0 or more, `b` where it is less or NaN.
    fn pick(self, a: Self, b: Self) -> Self;
    fn abs(self) -> Self {
        self.max(-self)
    }
}

macro_rules! scalar {
    ($type:ty, $form:ident) => {
        #[allow(clippy::disallowed_methods, reason = "the naive forms are those of the platform")]
        impl Real for $type {
            fn of(v: f64) -> Self {
                v as $type
            }
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            fn exp(self) -> Self {
                self.exp()
            }
            fn sin(self) -> Self {
                self.sin()
            }
            fn cos(self) -> Self {
                self.cos()
            }
            fn each(f: &Function, x: Self, y: Self) -> Self {
                (f.$form)(x, y)
            }
            fn floor(self) -> Self {
                self.floor()
            }
            fn min(self, b: Self) -> Self {
                self.min(b)
            }
            fn max(self, b: Self) -> Self {
                self.max(b)
            }
            fn pick(self, a: Self, b: Self) -> Self {
                if self >= 0.0 { a } else { b }
            }
        }
    };
}
scalar!(f32, narrow);
scalar!(f64, wide);

impl Real for F {
    fn of(v: f64) -> Self {
        lanes::splat(v as f32)
    }
    fn sqrt(self) -> Self {
        F::sqrt(self)
    }
    fn exp(self) -> Self {
        lanes_fn::exp(self)
    }
    fn sin(self) -> Self {
        lanes_fn::sin_cos(self).0
    }
    fn cos(self) -> Self {
        lanes_fn::sin_cos(self).1
    }
    fn each(f: &Function, x: Self, y: Self) -> Self {
        let (x, y) = (x.to_array(), y.to_array());
        F::new(std::array::from_fn(|i| (f.narrow)(x[i], y[i])))
    }
    fn floor(self) -> Self {
        F::floor(self)
    }
    fn min(self, b: Self) -> Self {
        self.at_most(b)
    }
    fn max(self, b: Self) -> Self {
        self.at_least(b)
    }
    fn pick(self, a: Self, b: Self) -> Self {
        self.simd_ge(F::ZERO).select(a, b)
    }
}

impl Real for D {
    fn of(v: f64) -> Self {
        splat_d(v)
    }
    fn sqrt(self) -> Self {
        D::sqrt(self)
    }
    fn exp(self) -> Self {
        D::exp(self)
    }
    fn sin(self) -> Self {
        D::sin(self)
    }
    fn cos(self) -> Self {
        D::cos(self)
    }
    fn each(f: &Function, x: Self, y: Self) -> Self {
        let (x, y) = (x.to_array(), y.to_array());
        D::new(std::array::from_fn(|i| (f.wide)(x[i], y[i])))
    }
    fn floor(self) -> Self {
        D::floor(self)
    }
    fn min(self, b: Self) -> Self {
        self.at_most(b)
    }
    fn max(self, b: Self) -> Self {
        self.at_least(b)
    }
    fn pick(self, a: Self, b: Self) -> Self {
        self.simd_ge(D::splat(0.0)).select(a, b)
    }
}

/// A vector.
pub type V<R> = [R; 3];

/// Three of the arguments, from `at` on.
pub fn vector<R: Real>(x: &Arguments<R>, at: usize) -> V<R> {
    [x[at], x[at + 1], x[at + 2]]
}

/// Arguments of a formula, some unused.
pub type Arguments<R> = [R; 16];

pub fn dot<R: Real>(a: V<R>, b: V<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn sub<R: Real>(a: V<R>, b: V<R>) -> V<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn cross<R: Real>(a: V<R>, b: V<R>) -> V<R> {
    [a[1] * b[2] - b[1] * a[2], a[2] * b[0] - b[2] * a[0], a[0] * b[1] - b[0] * a[1]]
}
