//! Real roots of a t² + b t + c, to half an ulp.
//!
//! Products of two f32 are exact in f64, so the discriminant b² - 4ac is rounded once, its sign is right, and
//! nothing cancels in q = -½ (b + sign(b) √(b² - 4ac)); the roots are q/a and c/q (Kahan).

/// The roots, the lesser first, or `None` if there is none or a coefficient is no finite number. A double
/// root, or that of a straight line (a = 0), comes twice; a root beyond the range of f32 is infinite.
///
/// Error at most 0.5001 ulp of each root.
pub fn roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]> {
    let [a, b, c] = [a, b, c].map(f64::from);
    let square = b * b - 4.0 * a * c;
    if !(0.0..f64::INFINITY).contains(&square) || (a == 0.0 && b == 0.0) {
        return None;
    }
    let q = -0.5 * (b + square.sqrt().copysign(b));
    // With q = 0, b and a c are 0 too, and so are the roots.
    let other = if q == 0.0 { 0.0 } else { c / q };
    let one = if a == 0.0 { other } else { q / a };
    let (one, other) = (one as f32, other as f32);
    Some(if one < other { [one, other] } else { [other, one] })
}

#[cfg(test)]
mod tests;
