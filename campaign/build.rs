//! Tells the program for which target it was built, so that a campaign can record it.

fn main() {
    let target = std::env::var("TARGET").expect("cargo sets TARGET for build scripts");
    println!("cargo:rustc-env=PARACOSM_TARGET={target}");
    println!("cargo:rerun-if-changed=build.rs");
}
