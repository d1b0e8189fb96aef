//! The `scotopic` program: parse, call, print the error.

fn main() -> std::process::ExitCode {
    scotopic::cli::main()
}
