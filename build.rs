//! Tells the program what built it, for its reports: `rustc --version` and the level of optimisation.

use std::env;
use std::process::Command;

fn main() {
    // A new compiler or another profile builds this script anew; nothing else changes what it says.
    println!("cargo::rerun-if-changed=build.rs");
    if let Some(version) = rustc_version() {
        println!("cargo::rustc-env=WAVELANE_RUSTC={}", version.trim());
    }
    if let Ok(level) = env::var("OPT_LEVEL") {
        println!("cargo::rustc-env=WAVELANE_OPT_LEVEL={level}");
    }
}

/// None where the compiler does not say it; the report then does without.
fn rustc_version() -> Option<String> {
    let output = Command::new(env::var_os("RUSTC")?).arg("--version").output().ok()?;
    String::from_utf8(output.stdout).ok().filter(|_| output.status.success())
}
