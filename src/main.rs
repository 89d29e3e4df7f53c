//! The player.
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: u64 = a[1].parse().unwrap();
    let q = luc_core::quality::Quality::named(&a[2]).unwrap();
    let (w, h): (u32, u32) = (a[3].parse().unwrap(), a[4].parse().unwrap());
    let mut renderer = luc_core::render::Renderer::default();
    let mut pixels = vec![0; (w * h) as usize];
    for _ in 0..std::env::var("N").map_or(8, |n| n.parse().unwrap()) {
        let t = std::time::Instant::now();
        let mut sc = luc::show::scene(n);
        if a.len() > 6 {
            sc.overlay = 1.0;
        }
        renderer.frame(&sc, n, (w, h), &q, &mut pixels);
        eprint!("{:.1} ", t.elapsed().as_secs_f64() * 1e3);
    }
    eprintln!();
    let mut out = format!("P6 {w} {h} 255\n").into_bytes();
    for p in pixels {
        out.extend([(p >> 16) as u8, (p >> 8) as u8, p as u8]);
    }
    std::fs::write(&a[5], out).unwrap();
}
