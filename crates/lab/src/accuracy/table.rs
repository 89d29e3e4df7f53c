//! Rows of the study as a CSV file that grows while it runs, so that an interruption loses little.
//!
//! The first line says under what conditions the rows were made; rows of other conditions are not
//! continued. Empty fields are figures that were not asked for, or are infinite.

use std::fs::{File, OpenOptions, create_dir_all, read_to_string};
use std::io::Write;
use std::path::Path;

/// A figure of a row.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
#[allow(missing_docs, reason = "the names in ALL say it")]
pub enum Figure {
    Ms,
    MsLow,
    MsHigh,
    WallMs,
    Primary,
    Reflected,
    Refracted,
    Rough,
    Scatter,
    Shadow,
    Rays,
    Steps,
    Traced,
    Interpolated,
    Filled,
    EdgeSamples,
    Rmse,
    Psnr,
    Ssim,
    Flip,
    Greatest,
    PsnrOfSampling,
    Flicker,
}

impl Figure {
    /// All figures in order, with the names of their columns.
    pub const ALL: [(Figure, &str); 23] = [
        (Figure::Ms, "ms"),
        (Figure::MsLow, "ms_quartile_1"),
        (Figure::MsHigh, "ms_quartile_3"),
        (Figure::WallMs, "ms_wall"),
        (Figure::Primary, "rays_primary"),
        (Figure::Reflected, "rays_reflected"),
        (Figure::Refracted, "rays_refracted"),
        (Figure::Rough, "rays_rough"),
        (Figure::Scatter, "rays_scatter"),
        (Figure::Shadow, "rays_shadow"),
        (Figure::Rays, "rays"),
        (Figure::Steps, "steps"),
        (Figure::Traced, "traced"),
        (Figure::Interpolated, "interpolated"),
        (Figure::Filled, "filled"),
        (Figure::EdgeSamples, "edge_samples"),
        (Figure::Rmse, "rmse"),
        (Figure::Psnr, "psnr_db"),
        (Figure::Ssim, "ssim"),
        (Figure::Flip, "flip"),
        (Figure::Greatest, "greatest"),
        (Figure::PsnrOfSampling, "psnr_sampling_db"),
        (Figure::Flicker, "flicker"),
    ];
}

/// What one setting of one knob did to one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the part.
    pub part: String,
    /// Frame of the part.
    pub frame: u64,
    /// Name of the knob.
    pub knob: String,
    /// Its position.
    pub value: String,
    /// In the order of [`Figure`]; NaN where not asked for.
    pub figures: [f64; Figure::ALL.len()],
}

impl Row {
    /// A figure.
    pub fn get(&self, figure: Figure) -> f64 {
        self.figures[figure as usize]
    }

    /// Sets a figure.
    pub fn set(&mut self, figure: Figure, value: f64) {
        self.figures[figure as usize] = value;
    }

    /// Whether it is about this frame and setting.
    pub fn is(&self, part: &str, frame: u64, knob: &str, value: &str) -> bool {
        self.part == part && self.frame == frame && self.knob == knob && self.value == value
    }

    fn write(&self) -> String {
        let mut line = format!("{},{},{},\"{}\"", self.part, self.frame, self.knob, self.value);
        for figure in self.figures {
            line.push(',');
            if figure.is_finite() {
                line += &short(figure);
            }
        }
        line + "\n"
    }

    fn read(line: &str) -> Option<Row> {
        let (before, rest) = line.split_once('"')?;
        let (value, after) = rest.split_once('"')?;
        let mut names = before.split(',').map(String::from);
        let (part, frame, knob) = (names.next()?, names.next()?.parse().ok()?, names.next()?);
        let mut fields = after.split(',').skip(1);
        let mut figures = [f64::NAN; Figure::ALL.len()];
        for figure in &mut figures {
            let field = fields.next()?;
            *figure = if field.is_empty() { f64::NAN } else { field.parse().ok()? };
        }
        fields.next().is_none().then_some(Row { part, frame, knob, value: value.into(), figures })
    }
}

/// A number with five significant digits, without needless ones.
pub fn short(x: f64) -> String {
    if x == 0.0 || x.fract() == 0.0 && x.abs() < 1e15 {
        return format!("{x}");
    }
    let digits = (4 - x.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// A file of rows.
pub struct Table {
    file: File,
    /// What it holds.
    pub rows: Vec<Row>,
}

impl Table {
    /// Opens the file at `path` to continue it; starts anew if it is not there, was made under other
    /// `conditions`, or `fresh` is wanted. A last line cut short is dropped.
    pub fn open(path: &Path, conditions: &str, fresh: bool) -> Result<Table, String> {
        let fault = |e| format!("{}: {e}", path.display());
        if let Some(folder) = path.parent() {
            create_dir_all(folder).map_err(fault)?;
        }
        let old = if fresh { String::new() } else { read_to_string(path).unwrap_or_default() };
        let rows = if old.lines().next() == Some(conditions) { rows(&old) } else { Vec::new() };
        let mut file =
            OpenOptions::new().write(true).create(true).truncate(true).open(path).map_err(fault)?;
        let names: Vec<&str> = Figure::ALL.iter().map(|f| f.1).collect();
        let mut text = format!("{conditions}\npart,frame,knob,value,{}\n", names.join(","));
        rows.iter().for_each(|row| text += &row.write());
        file.write_all(text.as_bytes()).map_err(fault)?;
        Ok(Table { file, rows })
    }

    /// Adds a row, in the file too.
    pub fn add(&mut self, row: Row) -> Result<(), String> {
        self.file
            .write_all(row.write().as_bytes())
            .map_err(|e| format!("the table can't be written: {e}"))?;
        self.rows.push(row);
        Ok(())
    }
}

/// Reads the rows of a file's text, as far as they are whole.
fn rows(text: &str) -> Vec<Row> {
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    whole.lines().skip(2).map_while(Row::read).collect()
}

/// Conditions and rows of the file at `path`.
pub fn read(path: &Path) -> Result<(String, Vec<Row>), String> {
    let text = read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok((text.lines().next().unwrap_or_default().into(), rows(&text)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(value: &str) -> Row {
        let mut row = Row {
            part: "mirror".into(),
            frame: 600,
            knob: "shading".into(),
            value: value.into(),
            figures: std::array::from_fn(|i| i as f64 * 1.25),
        };
        row.set(Figure::Flicker, f64::NAN);
        row
    }

    #[test]
    fn rows_are_read_as_they_were_written() {
        for value in ["high", "GGX, two bounces", ""] {
            let written = row(value).write();
            let read = Row::read(written.trim_end()).expect(&written);
            assert_eq!(read.write(), written);
            assert!(read.get(Figure::Flicker).is_nan());
        }
    }

    #[test]
    fn an_interrupted_table_is_continued_and_one_of_other_conditions_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let mut table = Table::open(&path, "# one", false).unwrap();
        table.add(row("a")).unwrap();
        table.add(row("b")).unwrap();
        drop(table);
        let whole = read_to_string(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() - 5]).unwrap();
        let table = Table::open(&path, "# one", false).unwrap();
        assert_eq!(table.rows.len(), 1, "the row that was cut short is gone");
        assert!(table.rows[0].is("mirror", 600, "shading", "a"));
        assert_eq!(Table::open(&path, "# two", false).unwrap().rows.len(), 0);
    }

    #[test]
    fn numbers_are_short() {
        for (x, text) in
            [(0.0, "0"), (12.0, "12"), (1234567.0, "1234567"), (0.0123456, "0.012346"), (9.5, "9.5")]
        {
            assert_eq!(short(x), text);
        }
    }
}
