//! What each crate, module, part of the show and function costs in the packed file.
//!
//! A byte costs what the model's prediction of its bits was worth: `-log2` of their probabilities,
//! summed. The sum over all bytes is the payload, but for the rounding of its last byte. A
//! function that resembles an earlier one costs little here, which it owes to the earlier one.

use super::grouped;
use super::symbols::{Symbol, crate_of, module_of, part_of};
use std::collections::BTreeMap;
use std::fmt;

/// How many functions the table names.
const NAMED: usize = 40;

/// What belongs to no single part of the show.
const SHARED: &str = "(engine, player and what parts share)";

/// Bytes before and after packing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Bytes in the program.
    pub raw: usize,
    /// Bits in the packed file.
    pub bits: f64,
}

/// The costs of a program's parts, the dearest first.
#[derive(Debug)]
pub struct Costs {
    /// By crate.
    pub crates: Vec<(String, Cost)>,
    /// By module; the show's parts are modules.
    pub modules: Vec<(String, Cost)>,
    /// By part of the show; of a program without such parts none.
    pub parts: Vec<(String, Cost)>,
    /// By function or variable.
    pub symbols: Vec<(String, Cost)>,
}

impl Costs {
    /// Sums up `bits`, the cost of each byte, by `symbols`.
    pub fn new(symbols: &[Symbol], bits: &[f32]) -> Costs {
        let sum = |group: &dyn Fn(&str) -> String| {
            let mut sums = BTreeMap::<String, Cost>::new();
            for symbol in symbols {
                let bits = bits.get(symbol.range.clone()).unwrap_or(&[]);
                let cost = sums.entry(group(&symbol.name)).or_default();
                cost.raw += bits.len();
                cost.bits += bits.iter().map(|&bits| f64::from(bits)).sum::<f64>();
            }
            let mut sums: Vec<(String, Cost)> = sums.into_iter().collect();
            sums.sort_by(|(_, a), (_, b)| b.bits.total_cmp(&a.bits));
            sums
        };
        let mut parts = sum(&|name| part_of(name).unwrap_or(SHARED).to_owned());
        if parts.iter().all(|(part, _)| part == SHARED) {
            parts.clear();
        }
        Costs {
            crates: sum(&|name| crate_of(name).to_owned()),
            modules: sum(&module_of),
            parts,
            symbols: sum(&str::to_owned),
        }
    }
}

impl fmt::Display for Costs {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut table = |title: &str, rows: &[(String, Cost)]| {
            writeln!(f, "{:>8} {:>8}  {title}", "raw", "packed")?;
            for (name, cost) in rows {
                let packed = (cost.bits / 8.0).round() as i64;
                writeln!(f, "{:>8} {:>8}  {name}", grouped(cost.raw as i64), grouped(packed))?;
            }
            writeln!(f)
        };
        table("crate", &self.crates)?;
        table("module", &self.modules)?;
        if !self.parts.is_empty() {
            table("part of the show", &self.parts)?;
        }
        table("function", &self.symbols[..self.symbols.len().min(NAMED)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adds_up_by_group() {
        let symbol = |range, name: &str| Symbol { range, name: name.to_owned() };
        let symbols = [
            symbol(0..2, "[headers]"),
            symbol(2..5, "a::b::c"),
            symbol(5..6, "a::d::e"),
            symbol(6..8, "a::b::f"),
        ];
        let costs = Costs::new(&symbols, &[1.0, 1.0, 8.0, 8.0, 8.0, 4.0, 2.0, 2.0]);
        let row = |name: &str, raw, bits| (name.to_owned(), Cost { raw, bits });
        assert_eq!(costs.crates, [row("a", 6, 32.0), row("[headers]", 2, 2.0)]);
        assert_eq!(costs.modules, [row("a::b", 5, 28.0), row("a::d", 1, 4.0), row("[headers]", 2, 2.0)]);
        assert_eq!(costs.symbols[0], row("a::b::c", 3, 24.0));
        assert!(costs.to_string().contains("\n       5        4  a::b\n"));
        assert!(costs.parts.is_empty() && !costs.to_string().contains("part of the show"));
    }

    #[test]
    fn parts_of_the_show_add_up() {
        let symbol = |range, name: &str| Symbol { range, name: name.to_owned() };
        let names = ["luc::show::gold::scene", "<luc::show::gold::Bar>::new", "luc::show::text::line"];
        let symbols = [
            symbol(0..1, names[0]),
            symbol(1..2, names[1]),
            symbol(2..4, names[2]),
            symbol(4..5, "luc::show::end::scene"),
        ];
        let costs = Costs::new(&symbols, &[8.0, 16.0, 1.0, 1.0, 4.0]);
        let row = |name: &str, raw, bits| (name.to_owned(), Cost { raw, bits });
        assert_eq!(costs.parts, [row("gold", 2, 24.0), row("end", 1, 4.0), row(SHARED, 2, 2.0)]);
        assert!(costs.to_string().contains("  part of the show\n       2        3  gold\n"));
    }
}
