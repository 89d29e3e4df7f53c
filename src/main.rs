//! The player.
fn main() {
    let mut renderer = luc_core::render::Renderer::default();
    let mut pixels = vec![0; 1280 * 720];
    luc::show::frame(&mut renderer, 0, (1280, 720), &luc_core::quality::Quality::PRESETS[3].1, &mut pixels);
}
