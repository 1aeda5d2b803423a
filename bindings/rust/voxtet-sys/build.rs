//! Finds the libraries: VOXTET_LIBRARY_DIR names the folders that hold libvox and, with the features io and sim, libvox_io and
//! libvox_sim, separated as in PATH; without it pkg-config is asked. VOXTET_STATIC=1 links them statically.

use std::{env, process::Command};

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
