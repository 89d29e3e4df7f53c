//! The formulas as anyone may call them, against exact arithmetic: proptest draws numbers of uniform exponent,
//! dashu computes with rationals, so the truth has no rounding of its own.
//!
//! A failing case is shrunk, printed, and kept in `kernels.regressions`, whose cases are tried first.

mod kernels {
    mod cells;
    pub mod draw;
    mod formulas;
    mod hard;
    mod odd;
    mod packets;
    mod shapes;
    mod wide;
}
