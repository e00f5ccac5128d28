//! A survey of known truth, of any size, and how well its tiles stand for it.
//!
//! - `cargo run --release --example tiles_truth write POINTS FOLDER [FILES]`: LAZ files of a hilly square kilometre's worth of ground with
//!   ducks, pigs and machined parts standing on it, 10,000 points each 10 m; nothing of it is kept in memory.
//! - `cargo run --release --example tiles_truth check FOLDER`: of a tileset of it, the distance of the finest tiles' points from the truth, and
//!   how evenly they lie inside of tiles and within two spacings of a cut.

mod check;
mod scene;

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["write", points, folder] => scene::write(points.parse()?, 1, Path::new(folder)),
        ["write", points, folder, files] => {
            scene::write(points.parse()?, files.parse()?, Path::new(folder))
        }
        ["check", folder] => check::check(Path::new(folder)),
        _ => Err("write POINTS FOLDER [FILES], or check FOLDER".into()),
    }
}
