//! The report as a page: the tables, what changed since the last one, and a map of all bytes.
//!
//! The map is a picture of the program, a square for each byte, the darker the more bits it costs;
//! the line above it tells the offset, the cost and the symbol of the byte under the pointer. The page
//! needs nothing but itself. Of the last report it needs the list that [`list`] makes.

use super::costs::{Cost, Costs};
use super::symbols::Symbol;
use super::{Report, grouped};
use std::collections::BTreeMap;
use std::fmt::Write;

/// How many changes are named.
const CHANGES: usize = 40;

/// Each symbol's cost as a line: raw bytes, packed bits and the name, with tabs between.
pub fn list(costs: &Costs) -> String {
    costs.symbols.iter().map(|(name, cost)| format!("{}\t{:.1}\t{name}\n", cost.raw, cost.bits)).collect()
}

/// What became larger or smaller since the `last` list, packed bytes, the largest change first.
pub fn changes(costs: &Costs, last: &str) -> Vec<(String, f64)> {
    let mut change = BTreeMap::new();
    for line in last.lines() {
        let mut parts = line.splitn(3, '\t').skip(1);
        if let (Some(bits), Some(name)) =
            (parts.next().and_then(|bits| bits.parse::<f64>().ok()), parts.next())
        {
            change.insert(name.to_owned(), -bits / 8.0);
        }
    }
    for (name, cost) in &costs.symbols {
        *change.entry(name.clone()).or_default() += cost.bits / 8.0;
    }
    let mut changes: Vec<(String, f64)> =
        change.into_iter().filter(|(_, bytes)| bytes.abs() >= 0.5).collect();
    changes.sort_by(|(_, a), (_, b)| b.abs().total_cmp(&a.abs()));
    changes
}

/// The page; `bits` is the cost of each byte, `last` the list of the last report or nothing.
pub fn page(report: &Report, costs: &Costs, symbols: &[Symbol], bits: &[f32], last: &str) -> String {
    let mut page = String::from(HEAD);
    let _ = writeln!(page, "<pre>{}</pre>", escaped(&report.to_string()));
    if !last.is_empty() {
        let rows = changes(costs, last).into_iter().take(CHANGES);
        let rows = rows.map(|(name, bytes)| format!("<tr><td>{bytes:+.0}<td>{}", escaped(&name)));
        let _ = writeln!(page, "<h2>Since the last report</h2><table>{}</table>", rows.collect::<String>());
    }
    page.push_str("<h2>Every byte</h2><p id=at>&nbsp;</p><canvas id=map></canvas>\n");
    for (title, rows) in [
        ("By crate", &costs.crates),
        ("By module", &costs.modules),
        ("By part of the show", &costs.parts),
        ("By function", &costs.symbols),
    ] {
        if rows.is_empty() {
            continue;
        }
        let _ = writeln!(page, "<h2>{title}</h2><table><tr><th>raw<th>packed<th>{}</table>", table(rows));
    }
    // A sixteenth of a bit is a step; characters from '#' on need no escapes but the backslash.
    let shade = |&bits: &f32| match (bits * 16.0 / 3.0).round().clamp(0.0, 88.0) as u8 + b'#' {
        b'\\' => ' ',
        shade => char::from(shade),
    };
    let _ = writeln!(page, "<script>\nconst bits = \"{}\";", bits.iter().map(shade).collect::<String>());
    page.push_str("const symbols = [");
    for symbol in symbols {
        let _ = write!(page, "[{},{:?}],", symbol.range.start, escaped(&symbol.name));
    }
    page.push_str("];\n");
    page.push_str(SCRIPT);
    page
}

fn table(rows: &[(String, Cost)]) -> String {
    let row = |(name, cost): &(String, Cost)| {
        let packed = grouped((cost.bits / 8.0).round() as i64);
        format!("<tr><td>{}<td>{packed}<td>{}\n", grouped(cost.raw as i64), escaped(name))
    };
    rows.iter().map(row).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

const HEAD: &str = "<!doctype html><meta charset=utf-8><title>Where the bytes go</title>\n<style>\n\
    body { font: 14px sans-serif; margin: 2em; color: #222; background: #fff }\n\
    td, th { padding: 0 1em 0 0; text-align: right; font-variant-numeric: tabular-nums }\n\
    td:last-child, th:last-child { text-align: left; font-family: monospace }\n\
    #at { font-family: monospace; position: sticky; top: 0; background: #fff; min-height: 1.4em }\n\
    canvas { image-rendering: pixelated }\n</style>\n<h1>Where the bytes go</h1>\n";

const SCRIPT: &str = r#"const width = 256, side = 4, map = document.getElementById("map"), at = document.getElementById("at");
map.width = width; map.height = Math.ceil(bits.length / width);
map.style.width = width * side + "px"; map.style.height = map.height * side + "px";
const paint = map.getContext("2d"), picture = paint.createImageData(map.width, map.height);
const cost = i => (bits[i] == " " ? 57 : bits.charCodeAt(i) - 35) * 3 / 16;
for (let i = 0; i < bits.length; i++) {
  const c = Math.min(1, cost(i) / 8);
  picture.data.set([255 - 40 * c, 245 - 215 * c, 235 - 200 * c, 255], 4 * i);
}
paint.putImageData(picture, 0, 0);
map.onmousemove = event => {
  const i = Math.floor(event.offsetY / side) * width + Math.floor(event.offsetX / side);
  if (i >= bits.length) return;
  let low = 0, high = symbols.length;
  while (high - low > 1) { const middle = low + high >> 1; if (symbols[middle][0] <= i) low = middle; else high = middle; }
  at.innerHTML = "0x" + i.toString(16) + " &nbsp; " + cost(i).toFixed(1) + " bits &nbsp; " + symbols[low][1];
};
</script>
"#;

#[cfg(test)]
mod tests {
    use super::*;

    fn costs(bits: &[f32]) -> (Vec<Symbol>, Costs) {
        let symbol = |range, name: &str| Symbol { range, name: name.to_owned() };
        let symbols = vec![symbol(0..2, "a::b<c>"), symbol(2..3, "a::\"d\"")];
        let costs = Costs::new(&symbols, bits);
        (symbols, costs)
    }

    #[test]
    fn tells_what_changed() {
        let (_, old) = costs(&[8.0, 8.0, 16.0]);
        let (_, new) = costs(&[8.0, 8.0, 80.0]);
        assert!(changes(&old, &list(&old)).is_empty());
        assert_eq!(changes(&new, &list(&old)), [("a::\"d\"".to_owned(), 8.0)]);
        let gone = changes(&new, "5\t40.0\tx::y\n");
        assert_eq!(gone[0], ("a::\"d\"".to_owned(), 10.0));
        assert!(gone.contains(&("x::y".to_owned(), -5.0)));
    }

    #[test]
    fn names_and_costs_stand_in_the_page() {
        let (symbols, costs) = costs(&[0.0, 10.7, 1.0]);
        let report = Report { linked: 9, stripped: 3, payload: 2, launcher: 1, total: 3, limit: 3 };
        let page = page(&report, &costs, &symbols, &[0.0, 10.7, 1.0], "");
        assert!(page.contains("const bits = \"# (\";"), "{page}");
        assert!(page.contains("[0,\"a::b&lt;c&gt;\"],[2,\"a::\\\"d\\\"\"],"));
        assert!(page.contains("<tr><td>2<td>1<td>a::b&lt;c&gt;"));
    }
}
