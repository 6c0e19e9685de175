//! Compiles `glsl/**` to SPIR-V and writes what Rust must know about each shader next to it:
//! its bindings, push-constant size, workgroup size and the offset of every block member, all
//! read back from the SPIR-V itself, so that the two languages cannot drift apart.
//!
//! Features choose the compiler: `shaderc` (in process, default), `glslc` (the program), neither
//! (the SPIR-V under `spirv/`, shipped for hosts without a C++ toolchain).

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

#[allow(dead_code)] // `counted` is a test's
#[path = "build/uniforms.rs"]
mod uniforms;

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo"));
    let glsl = root.join("glsl");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=build/uniforms.rs");
    println!("cargo:rerun-if-env-changed=WHITEWATER_SPIRV_OUT");

    if !cfg!(any(feature = "shaderc", feature = "glslc")) {
        copy_folder(&root.join("spirv"), &out);
        return;
    }
    compile_all(&glsl, &Compiler::new(&root), &out);
    // The shipped SPIR-V is made by this, and a test compares it.
    if let Some(folder) = env::var_os("WHITEWATER_SPIRV_OUT") {
        let folder = PathBuf::from(folder);
        fs::create_dir_all(&folder).expect("WHITEWATER_SPIRV_OUT can be made");
        copy_folder(&out, &folder);
    }
}

fn copy_folder(from: &Path, to: &Path) {
    println!("cargo:rerun-if-changed={}", from.display());
    let entries = fs::read_dir(from).unwrap_or_else(|error| panic!("{}: {error}", from.display()));
    for path in entries.flatten().map(|entry| entry.path()) {
        if matches!(path.extension().and_then(|e| e.to_str()), Some("spv" | "rs")) {
            let name = path.file_name().expect("a file has a name");
            fs::copy(&path, to.join(name))
                .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        }
    }
}

fn compile_all(glsl: &Path, compiler: &Compiler, out: &Path) {
    // What an earlier build left of shaders that are gone.
    for stale in fs::read_dir(out).expect("OUT_DIR").flatten().map(|entry| entry.path()) {
        if stale.extension().is_some_and(|e| e == "spv") {
            fs::remove_file(stale).expect("OUT_DIR is writable");
        }
    }
    let mut sources = Vec::new();
    find_shaders(glsl, &mut sources);
    sources.sort();
    let mut generated = String::new();
    let mut all = String::from("/// All there are.\npub const ALL: &[Shader] = &[\n");
    for path in &sources {
        println!("cargo:rerun-if-changed={}", path.display());
        let name = relative_name(glsl, path);
        let file = format!("{}.spv", name.replace('/', "."));
        let words = uniforms::hoisted(&compiler.compile(path, &name, true));
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        fs::write(out.join(&file), &bytes).expect("OUT_DIR is writable");
        // The optimiser drops the names: the interface is read from a second, plain compilation.
        let module = Module::parse(&compiler.compile(path, &name, false));
        write_shader(&mut generated, &name, &file, &module);
        writeln!(all, "    {},", constant(&name)).expect("String");
    }
    all.push_str("];\n");
    generated.push_str(&all);
    for include in fs::read_dir(glsl.join("include")).expect("glsl/include").flatten() {
        println!("cargo:rerun-if-changed={}", include.path().display());
    }
    println!("cargo:rerun-if-changed={}", glsl.display());
    fs::write(out.join("shaders.rs"), generated).expect("OUT_DIR is writable");
}

fn find_shaders(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("glsl folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            println!("cargo:rerun-if-changed={}", path.display());
            find_shaders(&path, found);
        } else if matches!(
            path.extension().and_then(|e| e.to_str()),
            Some("vert" | "frag" | "comp")
        ) {
            found.push(path);
        }
    }
}

/// `water/cull.comp` for `glsl/water/cull.comp`.
fn relative_name(glsl: &Path, path: &Path) -> String {
    let relative = path.strip_prefix(glsl).expect("inside glsl");
    relative.to_string_lossy().replace('\\', "/")
}

#[cfg(feature = "shaderc")]
struct Compiler {
    include: PathBuf,
    compiler: shaderc::Compiler,
}

#[cfg(feature = "shaderc")]
impl Compiler {
    fn new(root: &Path) -> Self {
        Self {
            include: root.join("glsl/include"),
            compiler: shaderc::Compiler::new().expect("shaderc starts"),
        }
    }

    fn compile(&self, path: &Path, name: &str, optimise: bool) -> Vec<u32> {
        let source = fs::read_to_string(path).expect("shader is readable");
        let kind = match path.extension().and_then(|e| e.to_str()) {
            Some("vert") => shaderc::ShaderKind::Vertex,
            Some("frag") => shaderc::ShaderKind::Fragment,
            _ => shaderc::ShaderKind::Compute,
        };
        let mut options = shaderc::CompileOptions::new().expect("shaderc starts");
        // 1.3 SPIR-V would need maintenance4 (LocalSizeId).
        options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_2 as u32);
        if optimise {
            options.set_optimization_level(shaderc::OptimizationLevel::Performance);
        } else {
            options.set_generate_debug_info();
        }
        options.set_warnings_as_errors();
        let include = self.include.clone();
        options.set_include_callback(move |wanted, _, _, _| {
            let file = include.join(wanted);
            let content = fs::read_to_string(&file)
                .map_err(|error| format!("{}: {error}", file.display()))?;
            Ok(shaderc::ResolvedInclude { resolved_name: file.display().to_string(), content })
        });
        match self.compiler.compile_into_spirv(&source, kind, name, "main", Some(&options)) {
            Ok(artifact) => artifact.as_binary().to_vec(),
            Err(error) => panic!("{error}"),
        }
    }
}

#[cfg(all(feature = "glslc", not(feature = "shaderc")))]
struct Compiler {
    include: PathBuf,
}

#[cfg(all(feature = "glslc", not(feature = "shaderc")))]
impl Compiler {
    fn new(root: &Path) -> Self {
        Self { include: root.join("glsl/include") }
    }

    fn compile(&self, path: &Path, name: &str, optimise: bool) -> Vec<u32> {
        let file = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo")).join("glslc.spv");
        let run = std::process::Command::new("glslc")
            .args(["--target-env=vulkan1.2", if optimise { "-O" } else { "-g" }, "-Werror", "-I"])
            .arg(&self.include)
            .arg("-o")
            .arg(&file)
            .arg(path)
            .output()
            .unwrap_or_else(|error| {
                panic!("cannot run glslc ({error}): install the package `glslc`, or use the feature `shaderc`")
            });
        assert!(run.status.success(), "{name}: {}", String::from_utf8_lossy(&run.stderr));
        read_words(&file)
    }
}

#[cfg(not(any(feature = "shaderc", feature = "glslc")))]
struct Compiler;

#[cfg(not(any(feature = "shaderc", feature = "glslc")))]
impl Compiler {
    fn new(_root: &Path) -> Self {
        Self
    }

    fn compile(&self, _path: &Path, name: &str, _optimise: bool) -> Vec<u32> {
        unreachable!("{name}: the shipped SPIR-V is used")
    }
}

#[cfg(all(feature = "glslc", not(feature = "shaderc")))]
fn read_words(file: &Path) -> Vec<u32> {
    let bytes = fs::read(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// What is read back from a SPIR-V module (only the instructions that are needed here).
#[derive(Default)]
struct Module {
    names: BTreeMap<u32, String>,
    member_names: BTreeMap<(u32, u32), String>,
    member_offsets: BTreeMap<(u32, u32), u32>,
    bindings: BTreeMap<u32, u32>,
    sets: BTreeMap<u32, u32>,
    pointers: BTreeMap<u32, (u32, u32)>,
    structs: BTreeMap<u32, Vec<u32>>,
    type_sizes: BTreeMap<u32, u32>,
    images: BTreeMap<u32, u32>,
    sampled_images: Vec<u32>,
    variables: Vec<(u32, u32, u32)>,
    locations: BTreeMap<u32, u32>,
    local_size: [u32; 3],
}

impl Module {
    fn parse(words: &[u32]) -> Self {
        assert_eq!(words.first(), Some(&0x0723_0203), "not a SPIR-V module");
        let mut module = Self { local_size: [1; 3], ..Self::default() };
        let mut matrix_stride = BTreeMap::new();
        let mut constants = BTreeMap::new();
        let mut at = 5;
        while at < words.len() {
            let (length, op) = ((words[at] >> 16) as usize, words[at] & 0xffff);
            let a = &words[at + 1..at + length];
            match op {
                5 => drop(module.names.insert(a[0], text(&a[1..]))),
                6 => drop(module.member_names.insert((a[0], a[1]), text(&a[2..]))),
                16 if a[1] == 17 => module.local_size = [a[2], a[3], a[4]],
                21 | 22 => drop(module.type_sizes.insert(a[0], a[1] / 8)),
                23 | 24 => {
                    let size = module.type_sizes.get(&a[1]).copied().unwrap_or(0) * a[2];
                    module.type_sizes.insert(a[0], size);
                }
                25 => drop(module.images.insert(a[0], a[6])),
                27 => module.sampled_images.push(a[0]),
                20 => drop(module.type_sizes.insert(a[0], 4)),
                // Specialised ones by their defaults: none is the length of a shared array.
                43 | 50 => drop(constants.insert(a[1], a[2])),
                28 => {
                    let count = constants.get(&a[2]).copied().unwrap_or(0);
                    let size = module.type_sizes.get(&a[1]).copied().unwrap_or(0) * count;
                    module.type_sizes.insert(a[0], size);
                }
                30 => {
                    let size = |member| module.type_sizes.get(member).copied().unwrap_or(0);
                    let size = a[1..].iter().map(size).sum();
                    module.type_sizes.insert(a[0], size);
                    module.structs.insert(a[0], a[1..].to_vec());
                }
                32 => drop(module.pointers.insert(a[0], (a[1], a[2]))),
                59 => module.variables.push((a[0], a[1], a[2])),
                71 if a[1] == 30 => drop(module.locations.insert(a[0], a[2])),
                71 if a[1] == 33 => drop(module.bindings.insert(a[0], a[2])),
                71 if a[1] == 34 => drop(module.sets.insert(a[0], a[2])),
                72 if a[2] == 35 => drop(module.member_offsets.insert((a[0], a[1]), a[3])),
                72 if a[2] == 7 => drop(matrix_stride.insert((a[0], a[1]), a[3])),
                _ => {}
            }
            at += length;
        }
        module
    }

    /// Descriptor kind of each binding of set 0, as the name of a `vk::DescriptorType`.
    fn descriptors(&self) -> BTreeMap<u32, &'static str> {
        let mut found = BTreeMap::new();
        for &(pointer, id, storage) in &self.variables {
            let Some(&binding) = self.bindings.get(&id) else { continue };
            assert_eq!(self.sets.get(&id), Some(&0), "only set 0 is used");
            let pointee = self.pointers[&pointer].1;
            let kind = match storage {
                2 => "UNIFORM_BUFFER",
                12 => "STORAGE_BUFFER",
                0 if self.sampled_images.contains(&pointee) => "COMBINED_IMAGE_SAMPLER",
                0 if self.images.get(&pointee) == Some(&2) => "STORAGE_IMAGE",
                _ => panic!("binding {binding}: storage class {storage} is not in use here"),
            };
            if let Some(earlier) = found.insert(binding, kind) {
                assert_eq!(earlier, kind, "binding {binding} has two kinds");
            }
        }
        found
    }

    /// Bytes that a workgroup shares.
    fn shared(&self) -> u32 {
        let shared = self.variables.iter().filter(|(_, _, storage)| *storage == 4);
        shared.map(|(pointer, ..)| self.type_sizes[&self.pointers[pointer].1]).sum()
    }

    /// Places of a stage's results: of a fragment shader its attachments.
    fn outputs(&self) -> u32 {
        let written =
            |(_, id, storage): &&(u32, u32, u32)| *storage == 3 && self.locations.contains_key(id);
        self.variables.iter().filter(written).count() as u32
    }

    /// Push-constant block: its type, and its size in bytes.
    fn push(&self) -> Option<(u32, u32)> {
        let (pointer, _, _) = self.variables.iter().find(|v| v.2 == 9)?;
        let block = self.pointers[pointer].1;
        let members = &self.structs[&block];
        let last = members.len() as u32 - 1;
        let size = self.member_offsets[&(block, last)] + self.type_sizes[&members[last as usize]];
        Some((block, size))
    }
}

/// A nul-terminated SPIR-V literal string.
fn text(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

fn constant(name: &str) -> String {
    name.replace(['/', '.'], "_").to_uppercase()
}

fn write_shader(out: &mut String, name: &str, file: &str, module: &Module) {
    let constant = constant(name);
    let push_size = module.push().map_or(0, |(_, size)| size);
    writeln!(out, "/// `{name}`").expect("String");
    writeln!(out, "pub const {constant}: Shader = Shader {{").expect("String");
    writeln!(out, "    name: \"{name}\",").expect("String");
    writeln!(
        out,
        "    code: {{ const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{file}\"))); &CODE.0 }},"
    )
    .expect("String");
    writeln!(out, "    push_size: {push_size},").expect("String");
    writeln!(out, "    local_size: {:?},", module.local_size).expect("String");
    writeln!(out, "    shared: {},", module.shared()).expect("String");
    writeln!(out, "    outputs: {},", module.outputs()).expect("String");
    out.push_str("    bindings: &[");
    for (binding, kind) in module.descriptors() {
        write!(out, "({binding}, vk::DescriptorType::{kind}), ").expect("String");
    }
    out.push_str("],\n    members: &[");
    for (&(block, member), offset) in &module.member_offsets {
        let (Some(block_name), Some(member_name)) =
            (module.names.get(&block), module.member_names.get(&(block, member)))
        else {
            continue;
        };
        write!(out, "(\"{block_name}\", \"{member_name}\", {offset}), ").expect("String");
    }
    out.push_str("],\n};\n");
}
