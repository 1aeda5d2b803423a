//! Compiles the libraries from vendor/, which the published crate has (packages/crate), with a C++ compiler and nothing else.
//! Installed ones instead: VOXTET_LIBRARY_DIR names the folders that hold libvox and, with the features io and sim, libvox_io and
//! libvox_sim, separated as in PATH; VOXTET_SYSTEM=1, or no vendor/, asks pkg-config. VOXTET_STATIC=1 links those statically.

use std::{env, path::Path, process::Command};

/// The source drop in vendor/ (packages/source_drop.py), compiled as it says.
fn compile(io: bool, sim: bool) {
    println!("cargo:rerun-if-changed=vendor");
    let mut build = cc::Build::new();
    build.cpp(true).std("c++20").opt_level(3); // in debug builds too: a step is to take the time it takes
    build.includes(["vendor/include", "vendor/src", "vendor/third_party"]).define("VOX_STATIC", None);
    build.flag_if_supported("-ffp-contract=off").warnings(false);
    for part in [Some("core"), io.then_some("io"), sim.then_some("sim")].into_iter().flatten() {
        let mut files: Vec<_> = std::fs::read_dir(format!("vendor/all/{part}"))
            .unwrap_or_else(|error| panic!("vendor/all/{part}: {error}"))
            .map(|entry| entry.expect("a readable folder").path())
            .collect();
        files.sort();
        build.files(files);
    }
    build.compile("vox");
}

fn main() {
    println!("cargo:rerun-if-env-changed=VOXTET_LIBRARY_DIR");
    println!("cargo:rerun-if-env-changed=VOXTET_STATIC");
    let mut names = vec!["vox"];
    if env::var_os("CARGO_FEATURE_IO").is_some() {
        names.push("vox_io");
    }
    if env::var_os("CARGO_FEATURE_SIM").is_some() {
        names.push("vox_sim");
    }
    println!("cargo:rerun-if-env-changed=VOXTET_SYSTEM");
    let is_asked_for = |name| env::var_os(name).is_some();
    if Path::new("vendor").is_dir() && !is_asked_for("VOXTET_LIBRARY_DIR") && !is_asked_for("VOXTET_SYSTEM") {
        compile(names.contains(&"vox_io"), names.contains(&"vox_sim"));
        return;
    }
    let is_static = env::var("VOXTET_STATIC").is_ok_and(|value| value == "1");
    let kind = if is_static { "static" } else { "dylib" };
    if let Some(folders) = env::var_os("VOXTET_LIBRARY_DIR") {
        for folder in env::split_paths(&folders) {
            println!("cargo:rustc-link-search=native={}", folder.display());
        }
        for name in &names {
            println!("cargo:rustc-link-lib={kind}={name}");
        }
        if is_static && env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
            println!("cargo:rustc-link-lib=dylib=stdc++");
        }
        return;
    }
    for name in &names {
        let mut command = Command::new(env::var_os("PKG_CONFIG").unwrap_or_else(|| "pkg-config".into()));
        command.args(["--libs", name]);
        if is_static {
            command.arg("--static");
        }
        let flags = match command.output() {
            Ok(done) if done.status.success() => String::from_utf8_lossy(&done.stdout).into_owned(),
            Ok(done) => panic!(
                "pkg-config does not know {name}; install vox, or name its folder in VOXTET_LIBRARY_DIR\n{}",
                String::from_utf8_lossy(&done.stderr)
            ),
            Err(error) => {
                panic!("pkg-config cannot be run ({error}); name the folder of lib{name} in VOXTET_LIBRARY_DIR")
            }
        };
        for flag in flags.split_whitespace() {
            if let Some(folder) = flag.strip_prefix("-L") {
                println!("cargo:rustc-link-search=native={folder}");
            } else if let Some(library) = flag.strip_prefix("-l") {
                let kind = if names.contains(&library) { kind } else { "dylib" };
                println!("cargo:rustc-link-lib={kind}={library}");
            }
        }
    }
}
