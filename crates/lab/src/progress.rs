//! A bar on standard error with the share that is done, the time left, and what is being done.
//!
//! On a terminal one line that is written over; elsewhere a line now and then.

use std::io::{IsTerminal, Write, stderr};
use std::time::{Duration, Instant};

/// Cells of the bar.
const WIDTH: usize = 24;
/// Time between two updates on a terminal, and elsewhere.
const PACE: [Duration; 2] = [Duration::from_millis(100), Duration::from_secs(20)];

/// The bar.
pub struct Progress {
    total: f64,
    done: f64,
    start: Instant,
    shown: Option<Instant>,
    terminal: bool,
}

impl Progress {
    /// For `total` units of work.
    pub fn new(total: f64) -> Self {
        Self { total, done: 0.0, start: Instant::now(), shown: None, terminal: stderr().is_terminal() }
    }

    /// Tells that `units` more are done and what comes next.
    pub fn step(&mut self, units: f64, next: &str) {
        self.done += units;
        let pace = PACE[usize::from(!self.terminal)];
        if self.shown.is_none_or(|t| t.elapsed() >= pace) {
            self.shown = Some(Instant::now());
            let line = line(self.done / self.total, self.start.elapsed(), next);
            // A bar that can't be shown is no reason to stop.
            let _ = match self.terminal {
                true => write!(stderr(), "\r\x1b[K{line}"),
                false => writeln!(stderr(), "{line}"),
            };
        }
    }

    /// Takes the bar away and says what became of it.
    pub fn end(self, words: &str) {
        let clear = if self.terminal { "\r\x1b[K" } else { "" };
        let _ = writeln!(stderr(), "{clear}{words}, {} in all", duration(self.start.elapsed()));
    }
}

fn line(share: f64, elapsed: Duration, next: &str) -> String {
    let share = share.clamp(0.0, 1.0);
    let full = (share * WIDTH as f64) as usize;
    let left = match share > 0.005 {
        true => format!("{} left", duration(elapsed.mul_f64((1.0 - share) / share))),
        false => String::from("..."),
    };
    let bar = "#".repeat(full) + &"-".repeat(WIDTH - full);
    format!("[{bar}] {:3.0} %  {left}  {next}", share * 100.0)
}

/// A duration as minutes and seconds, or hours and minutes.
pub fn duration(time: Duration) -> String {
    let s = time.as_secs();
    if s >= 3600 {
        format!("{} h {:02} min", s / 3600, s / 60 % 60)
    } else {
        format!("{}:{:02} min", s / 60, s % 60)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_follows_from_what_is_done() {
        let text = line(0.25, Duration::from_secs(60), "mirror");
        assert_eq!(text, "[######------------------]  25 %  3:00 min left  mirror");
        assert_eq!(duration(Duration::from_secs(3 * 3600 + 59)), "3 h 00 min");
        assert!(line(2.0, Duration::ZERO, "").contains("100 %"), "no more than all");
    }
}
