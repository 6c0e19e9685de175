//! Compiles `glsl/*.comp` to SPIR-V: by the `shaderc` library (default), else by the program `glslc`.

use std::path::{Path, PathBuf};
use std::{env, fs};

// The library's build does the same, so both sides of a timing come from the same compiler.
#[allow(dead_code)] // `counted` is a test's
#[path = "../../build/uniforms.rs"]
mod uniforms;

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo"));
    let glsl = root.join("glsl");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=../../build/uniforms.rs");
    println!("cargo:rerun-if-changed={}", glsl.display());
    println!("cargo:rerun-if-changed={}", glsl.join("include").display());
    for include in fs::read_dir(glsl.join("include")).expect("glsl/include").flatten() {
        println!("cargo:rerun-if-changed={}", include.path().display());
    }
    for path in fs::read_dir(&glsl).expect("glsl").flatten().map(|entry| entry.path()) {
        if path.extension().is_some_and(|e| e == "comp") {
            println!("cargo:rerun-if-changed={}", path.display());
            let name = path.file_name().expect("a file has a name").to_string_lossy().into_owned();
            let to = out.join(format!("{name}.spv"));
            compile(&path, &glsl.join("include"), &name, &to);
            let words = fs::read(&to).expect("it was written");
            let words: Vec<_> = words.chunks_exact(4).map(word).collect();
            let bytes = uniforms::hoisted(&words).into_iter().flat_map(u32::to_le_bytes);
            fs::write(&to, bytes.collect::<Vec<_>>()).expect("OUT_DIR is writable");
        }
    }
}

fn word(bytes: &[u8]) -> u32 {
    u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

#[cfg(feature = "shaderc")]
fn compile(path: &Path, include: &Path, name: &str, to: &Path) {
    let source = fs::read_to_string(path).expect("shader is readable");
    let compiler = shaderc::Compiler::new().expect("shaderc starts");
    let mut options = shaderc::CompileOptions::new().expect("shaderc starts");
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_2 as u32);
    options.set_optimization_level(shaderc::OptimizationLevel::Performance);
    options.set_warnings_as_errors();
    let include = include.to_path_buf();
    options.set_include_callback(move |wanted, _, _, _| {
        let file = include.join(wanted);
        let content =
            fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        Ok(shaderc::ResolvedInclude { resolved_name: file.display().to_string(), content })
    });
    let kind = shaderc::ShaderKind::Compute;
    match compiler.compile_into_spirv(&source, kind, name, "main", Some(&options)) {
        Ok(artifact) => fs::write(to, artifact.as_binary_u8()).expect("OUT_DIR is writable"),
        Err(error) => panic!("{error}"),
    }
}

#[cfg(not(feature = "shaderc"))]
fn compile(path: &Path, include: &Path, name: &str, to: &Path) {
    let run = std::process::Command::new("glslc")
        .args(["--target-env=vulkan1.2", "-O", "-Werror", "-I"])
        .arg(include)
        .arg("-o")
        .arg(to)
        .arg(path)
        .output()
        .unwrap_or_else(|error| {
            panic!("cannot run glslc ({error}): install the package `glslc`, or use the feature `shaderc`")
        });
    assert!(run.status.success(), "{name}: {}", String::from_utf8_lossy(&run.stderr));
}
