//! The `soffio` program.

fn main() -> std::process::ExitCode {
    soffio::commands::run()
}
