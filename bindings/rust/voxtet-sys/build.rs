//! Compiles the libraries from vendor/, which the published crate has (packages/crate), with a C++ compiler and nothing else.
//! Those that are there instead: VOXTET_LIBRARY_DIR names a build folder, or folders that hold libvox and, with the features io and
//! sim, libvox_io and libvox_sim, separated as in PATH; VOXTET_SYSTEM=1, or no vendor/, asks pkg-config. VOXTET_STATIC=1 links those
//! statically.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{exit, Command},
};

/// Cargo shows what a script that failed has written. A panic would put its own words around it.
fn fail(text: &str) -> ! {
    eprintln!("{text}");
    exit(1)
}

/// The folders of VOXTET_LIBRARY_DIR and, as each may be a build folder, where CMake leaves the libraries in it.
fn library_folders(named: &std::ffi::OsStr) -> Vec<PathBuf> {
    let mut folders = Vec::new();
    for folder in env::split_paths(named).filter(|folder| !folder.as_os_str().is_empty()) {
        if folder.is_relative() {
            fail(&format!(
                "VOXTET_LIBRARY_DIR is {0}, which cargo would look for elsewhere: say $PWD/{0}",
                folder.display()
            ));
        }
        folders.extend(
            ["", "src", "src/io", "src/sim", "bin"].iter().map(|part| folder.join(part)).filter(|f| f.is_dir()),
        );
    }
    folders
}

/// The files of a library in these folders, such as libvox.so and libvox.so.1.
fn files_of(name: &str, folders: &[PathBuf]) -> Vec<PathBuf> {
    let files =
        folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten().map(|entry| entry.path());
    files
        .filter(|file| {
            let file = file.file_name().unwrap_or_default().to_string_lossy();
            file.strip_prefix("lib").unwrap_or(&file).strip_prefix(name).is_some_and(|rest| rest.starts_with('.'))
        })
        .collect()
}

/// `cargo run` and `cargo test` have a program look for libraries where build scripts do, if that is in the target folder.
fn link_into_target(files: &[PathBuf]) {
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    println!("cargo:rustc-link-search=native={}", folder.display());
    #[cfg(unix)]
    for file in files {
        let link = folder.join(file.file_name().expect("a file has a name"));
        let _ = fs::remove_file(&link); // of an earlier run
        if let Err(error) = std::os::unix::fs::symlink(file, &link) {
            fail(&format!("{}: {error}", link.display()));
        }
    }
    #[cfg(not(unix))]
    let _ = files;
}

/// Links the libraries in these folders.
fn link(names: &[&str], named: &std::ffi::OsStr, is_static: bool) {
    let folders = library_folders(named);
    for name in names {
        let files = files_of(name, &folders);
        if files.is_empty() {
            fail(&format!(
                "VOXTET_LIBRARY_DIR is {}, in which there is no lib{name}: cmake --build BUILD_FOLDER --target {name}",
                named.to_string_lossy()
            ));
        }
        if !is_static {
            link_into_target(&files);
        }
        println!("cargo:rustc-link-lib={}={name}", if is_static { "static" } else { "dylib" });
    }
    for folder in folders {
        println!("cargo:rustc-link-search=native={}", folder.display());
    }
    if is_static && env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        println!("cargo:rustc-link-lib=dylib=stdc++");
    }
}

const HELP: &str = "voxtet-sys finds no libvox. In a clone, build it and name the build folder: ./dev demo, then
VOXTET_LIBRARY_DIR=$PWD/build/release cargo build. Otherwise install vox, so that pkg-config knows it.";

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
    if let Some(named) = env::var_os("VOXTET_LIBRARY_DIR") {
        return link(&names, &named, is_static);
    }
    for name in &names {
        let mut command = Command::new(env::var_os("PKG_CONFIG").unwrap_or_else(|| "pkg-config".into()));
        command.args(["--libs", name]);
        if is_static {
            command.arg("--static");
        }
        let flags = match command.output() {
            Ok(done) if done.status.success() => String::from_utf8_lossy(&done.stdout).into_owned(),
            Ok(done) => fail(&format!("{HELP}\n{}", String::from_utf8_lossy(&done.stderr))),
            Err(error) => fail(&format!("{HELP}\npkg-config: {error}")),
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
