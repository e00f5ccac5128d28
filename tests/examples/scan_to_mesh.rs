//! `cargo run --release --example scan_to_mesh scan.ply mesh.ply`: a third of the points, and the mesh through them.

use pointweave::base::progress::Silent;
use pointweave::formats::{Output, RawCloud, detect, read, write};
use pointweave::{SurfaceParams, reconstruct};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let [scan, mesh] = &names[..] else {
        return Err("two files are needed: the scan and the mesh to write".into());
    };
    let bytes = std::fs::read(scan)?;
    let cloud = read(&bytes, detect(&bytes, Some(scan))?)?.to_cloud()?;
    let surface = reconstruct(&cloud, &SurfaceParams::default(), &mut Silent)?;
    let file = RawCloud::of_surface(&surface);
    let name = mesh.rsplit('.').next().unwrap_or_default();
    let format = Output::from_name(name).ok_or("the mesh is a .ply, .glb, .obj, .stl or .xyz")?;
    let bytes = write(&file, Some(surface.indices()), format, Default::default())?;
    std::fs::write(mesh, bytes)?;
    println!(
        "{} points, {} triangles",
        cloud.len(),
        surface.report.triangles
    );
    Ok(())
}
