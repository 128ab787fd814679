//! `cargo run -p soffio-forge` writes all shipped models and breaths. With `-- --check` it writes nothing, and fails
//! where a file on disk differs.

use std::path::Path;
use std::process::ExitCode;

use soffio_forge as forge;

fn main() -> ExitCode {
    let check = std::env::args().skip(1).any(|argument| argument == "--check");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let artifacts = match forge::artifacts() {
        Ok(artifacts) => artifacts,
        Err(error) => {
            eprintln!("cannot make the breaths: {error}");
            return ExitCode::FAILURE;
        }
    };
    let mut stale = 0;
    for artifact in artifacts {
        let path = root.join(artifact.path);
        let fresh = std::fs::read(&path).is_ok_and(|bytes| bytes == artifact.bytes);
        if fresh {
            println!("same   {}", artifact.path);
        } else if check {
            eprintln!("STALE  {}: run `cargo run -p soffio-forge`", artifact.path);
            stale += 1;
        } else if let Err(error) = write(&path, &artifact.bytes) {
            eprintln!("cannot write {}: {error}", path.display());
            return ExitCode::FAILURE;
        } else {
            println!("wrote  {} ({} bytes)", artifact.path, artifact.bytes.len());
        }
    }
    for (name, mobile) in [
        ("steel-fish", forge::steel_fish::glb().0),
        ("plates", forge::plates::glb().0),
        ("lobster-tree", forge::lobster_tree::glb().0),
        ("snow", forge::snow::glb().0),
        ("twelve-moons", forge::twelve_moons::glb().0),
        ("windy-corner", forge::windy_corner::glb().0),
    ] {
        println!("\n{name}");
        report(&mobile);
    }
    if stale == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Prints the statics of a balanced mobile.
fn report(mobile: &soffio_authoring::mobile::Mobile) {
    for (piece, _) in &mobile.pieces {
        println!("{:<12} {:7.3} g", piece.name, 1e3 * piece.mass().mass);
    }
    let s = mobile.statics();
    println!("moving mass  {:7.3} g", 1e3 * s.total_mass);
    println!("imbalance    {:7.1e} m (worst hook)", s.worst_offset);
    println!("yaw inertia  {:7.5} kg m²", s.yaw_inertia);
    println!("depth        {:7.2} mm below the point", 1e3 * s.depth);
    println!("tilt period  {:7.3} s", s.tilt_period);
}

fn write(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::write(path, bytes)
}
