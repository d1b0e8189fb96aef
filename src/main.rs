//! The `scotopic` program: parse, call, print the error.

fn main() {}
