//! Writes files of the formats that the shared data have none or few of, to start from: `seeds <folder>`.

#[path = "../common/made.rs"]
mod made;

use made::Kept;
use std::path::PathBuf;

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).expect("a folder"));
    let write = |name: String, bytes: Vec<u8>| {
        std::fs::write(folder.join(name), bytes).expect("a file written")
    };
    for format in 0..=10 {
        let version = if format < 6 { (1, 3) } else { (1, 4) };
        write(
            format!("{format}.las"),
            made::las(format, 6, version, false),
        );
        if ![4, 5, 9, 10].contains(&format) {
            write(
                format!("{format}.laz"),
                made::las(format, 30, version, true),
            );
        }
    }
    for kept in [Kept::Single, Kept::Double, Kept::Scaled, Kept::Spherical] {
        write(format!("{kept:?}.e57"), made::e57(&[(kept, 8), (kept, 3)]));
    }
    let json = r#"{"accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":24}],"buffers":[{"byteLength":24}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0,"scale":[2,2,2]}],"scenes":[{"nodes":[0]}]}"#;
    write("small.glb".into(), made::glb(json, &[63; 24]));
}
