//! The blur of our bloom beside those of crates libblur and image.
//!
//! Ours is a binomial filter of seven taps along rows and columns, whose sigma is √1.5 px and no other; wider
//! ones are several in a row. It is held, as are the others, against a Gaussian in f64 that reaches nine sigmas,
//! for which a picture's edges are repeated as all of them do it. Each has its picture as it likes it best: ours
//! one colour after the other in each row, theirs the colours of a pixel together.

use crate::picture::Picture;
use crate::rays::unit;
use crate::turns::medians;
use image::{Rgb32FImage, imageops};
use libblur::{
    BlurImage, BlurImageMut, EdgeMode, EdgeMode2D, FastBlurChannels, GaussianBlurParams,
    IeeeBinaryConvolutionMode, ThreadingPolicy,
};

/// Passes of timing.
const PASSES: usize = 15;
/// The variance that one pass of ours adds, px².
const VARIANCE: f64 = 1.5;

/// A picture of these sides, colours of a pixel together, from 0 to 1: noise, over which bright discs lie.
fn picture([width, height]: [usize; 2]) -> Vec<f32> {
    let mut rgb = Vec::with_capacity(3 * width * height);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let (cell, [u, v]) = ((y / 32 * 1024 + x / 32) as u32, [x % 32, y % 32].map(|p| p as f32 - 15.5));
        let inside = u * u + v * v < 200.0 * unit(cell);
        for colour in 0..3 {
            let noise = 0.25 * unit(((y * width + x) * 3 + colour) as u32);
            rgb.push(if inside { 1.0 - noise } else { noise });
        }
    }
    rgb
}

/// Beyond this many pixels the Gaussian is nothing in f64.
fn reach(sigma: f64) -> usize {
    (9.0 * sigma).ceil() as usize
}

/// One way of a Gaussian in f64: along rows if `step` is 3, along columns if it is a row's length.
fn along(from: &[f64], sigma: f64, [step, count]: [usize; 2]) -> Vec<f64> {
    let reach = reach(sigma) as isize;
    let tap = |k: isize| (-0.5 * (k as f64 / sigma).powi(2)).exp();
    let total: f64 = (-reach..=reach).map(tap).sum();
    let taps: Vec<f64> = (-reach..=reach).map(|k| tap(k) / total).collect();
    let value = |i: usize| {
        let place = (i / step % count) as isize;
        let start = i - place as usize * step;
        let near = |k: isize| (place + k - reach).clamp(0, count as isize - 1) as usize;
        taps.iter().enumerate().map(|(k, tap)| tap * from[start + near(k as isize) * step]).sum()
    };
    (0..from.len()).map(value).collect()
}

/// Greatest and root mean square difference, but for a margin, as blurs in a row treat edges otherwise.
fn errors(blurred: &[f32], truth: &[f64], [width, height]: [usize; 2], margin: usize) -> [f64; 2] {
    let (mut greatest, mut squares, mut count) = (0.0_f64, 0.0, 0);
    for row in margin..height - margin {
        let part = 3 * (row * width + margin)..3 * ((row + 1) * width - margin);
        for (&a, b) in blurred[part.clone()].iter().zip(&truth[part]) {
            let difference = (f64::from(a) - b).abs();
            greatest = greatest.max(difference);
            squares += difference * difference;
            count += 1;
        }
    }
    [greatest, (squares / f64::from(count)).sqrt()]
}

/// The picture as our blur wants it.
fn planes(rgb: &[f32], [width, height]: [usize; 2]) -> Picture {
    let mut picture = Picture::default();
    picture.reset(width, height, 1);
    for (i, &value) in rgb.iter().enumerate() {
        let (pixel, colour) = (i / 3, i % 3);
        let at = picture.at(pixel % width, pixel / width) + colour * picture.stride();
        picture.light[at] = value;
    }
    picture
}

/// And back.
fn pixels(picture: &Picture) -> Vec<f32> {
    let value = |i: usize| {
        let (pixel, colour) = (i / 3, i % 3);
        picture.light[picture.at(pixel % picture.width, pixel / picture.width) + colour * picture.stride()]
    };
    (0..3 * picture.width * picture.height).map(value).collect()
}

/// A Gaussian by libblur, of as many taps; of those that it takes itself for none.
fn libblur(rgb: &[f32], size: [usize; 2], sigma: f64, taps: Option<u32>, out: &mut BlurImageMut<f32>) {
    let [width, height] = size.map(|n| n as u32);
    let from = BlurImage::borrow(rgb, width, height, FastBlurChannels::Channels3);
    let chosen = GaussianBlurParams::new_from_sigma(sigma);
    let params = taps.map_or(chosen, |taps| GaussianBlurParams::new(taps, sigma));
    let edges = EdgeMode2D::new(EdgeMode::Clamp);
    let (thread, mode) = (ThreadingPolicy::Single, IeeeBinaryConvolutionMode::Normal);
    libblur::gaussian_blur_f32(&from, out, params, edges, thread, mode).expect("pictures of one size");
}

/// Prints the rows of one size and as many of our passes in a row.
fn rows(size: [usize; 2], passes: usize) {
    let sigma = (VARIANCE * passes as f64).sqrt();
    let [width, height] = size;
    let rgb = picture(size);
    let exact: Vec<f64> = rgb.iter().map(|&v| v.into()).collect();
    let truth = along(&along(&exact, sigma, [3, width]), sigma, [3 * width, height]);

    // As many taps as a Gaussian has to 3.5 sigma, beyond which is a part in 2000 of it.
    let wide = 2 * (3.5 * sigma).ceil() as u32 + 1;
    let image =
        Rgb32FImage::from_raw(width as u32, height as u32, rgb.clone()).expect("three for each pixel");
    let blank = || BlurImageMut::alloc(width as u32, height as u32, FastBlurChannels::Channels3);
    let [mut few, mut many] = [blank(), blank()];
    let mut ours = planes(&rgb, size);
    let in_a_row = |picture: &mut Picture| (0..passes).for_each(|_| picture.blur());
    in_a_row(&mut ours);
    libblur(&rgb, size, sigma, None, &mut few);
    libblur(&rgb, size, sigma, Some(wide), &mut many);
    let blurred = [
        pixels(&ours),
        few.data.borrow().to_vec(),
        many.data.borrow().to_vec(),
        imageops::blur(&image, sigma as f32).into_raw(),
        imageops::fast_blur(&image, sigma as f32).into_raw(),
    ];

    let mut works: Vec<Box<dyn FnMut()>> = vec![
        // What is blurred already: its values don't matter to the time.
        Box::new(|| in_a_row(&mut ours)),
        Box::new(|| libblur(&rgb, size, sigma, None, &mut few)),
        Box::new(|| libblur(&rgb, size, sigma, Some(wide), &mut many)),
        Box::new(|| drop(imageops::blur(&image, sigma as f32))),
        Box::new(|| drop(imageops::fast_blur(&image, sigma as f32))),
    ];
    let times = medians(PASSES, &mut works);
    let names = [
        if passes == 1 { "Lúč".to_string() } else { format!("Lúč, {passes} in a row") },
        "libblur, its own taps".into(),
        format!("libblur, {wide} taps"),
        "image, blur".into(),
        "image, fast_blur".into(),
    ];
    let mut title = format!("{width}x{height}, {sigma:.2} px");
    for ((name, blurred), time) in names.iter().zip(&blurred).zip(times) {
        let [most, rms] = errors(blurred, &truth, size, reach(sigma));
        println!("| {title} | {name} | {time:.2} | {most:.1e} | {rms:.1e} |");
        title.clear();
    }
}

/// Prints the table: the size at which bloom first blurs 1920x1080, that size itself, and a wider blur of it.
pub fn run(quick: bool) {
    println!("| picture, sigma | blur | ms | greatest error | RMS |");
    println!("|---|---|---:|---:|---:|");
    let cases: &[([usize; 2], usize)] =
        if quick { &[([480, 270], 1)] } else { &[([480, 270], 1), ([1920, 1080], 1), ([1920, 1080], 6)] };
    for &(size, passes) in cases {
        rows(size, passes);
    }
}
