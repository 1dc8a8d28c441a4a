//! The program `gyrolab`; all of it is in the library.

fn main() -> std::process::ExitCode {
    gyrolab::cli::main()
}
