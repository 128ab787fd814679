//! Writes the scenes into a folder: `soffio-scenes DIR`.

use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let (Some(folder), None) = (arguments.next(), arguments.next()) else {
        eprintln!("usage: soffio-scenes DIR (writes measured/*.json and tuning/*.json there)");
        return ExitCode::from(2);
    };
    match write(&PathBuf::from(folder)) {
        Ok(written) => {
            println!("{written} scenes");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("soffio-scenes: {error}");
            ExitCode::from(1)
        }
    }
}

fn write(folder: &std::path::Path) -> std::io::Result<usize> {
    let mut written = 0;
    for (part, scenes) in [("measured", soffio_scenes::measured()), ("tuning", soffio_scenes::tuning())] {
        let folder = folder.join(part);
        std::fs::create_dir_all(&folder)?;
        for scene in scenes {
            std::fs::write(folder.join(format!("{}.json", scene.name)), scene.to_json() + "\n")?;
            written += 1;
        }
    }
    Ok(written)
}
