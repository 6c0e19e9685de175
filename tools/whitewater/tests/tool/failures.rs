//! Each kind of failure has its exit code and one line that says what to do, and leaves no incomplete file.

use std::os::unix::fs::{PermissionsExt, symlink};

use fs4::{FileExt, TryLockError};

use super::support::{Folder, SIZE, SMALL, block, names};

#[test]
fn bad_inputs_are_code_3() {
    let folder = Folder::new();
    folder.particles("a.ply", block(4));
    folder.text("empty.bgeo", "");
    folder.text("words.dat", "these are no particles");
    let bytes = std::fs::read(folder.path("a.ply")).unwrap();
    std::fs::write(folder.path("cut.ply"), &bytes[..bytes.len() - 7]).unwrap();
    for (input, part) in [
        ("missing.ply", "no such file"),
        ("missing_%04d.ply", "no file fits"),
        ("missing_*.ply", "no file fits"),
        ("empty.bgeo", "empty"),
        ("cut.ply", "ends too early"),
        ("words.dat", "expected"),
        (".", "folder of several"),
    ] {
        folder.run(&format!("render {input} -o out.png {SMALL}")).fails(3, &[part]);
        folder.run(&format!("info {input}")).fails(3, &[part]);
        assert!(!folder.exists("out.png"));
    }
}

#[test]
fn bad_cameras_settings_and_scenes_are_code_3() {
    let folder = Folder::new();
    folder.particles("a.ply", block(3));
    for (text, part) in [
        ("{", "expected a camera"),
        (r#"{"eye":[0,0,1]}"#, "target"),
        (r#"{"eye":[0,0,1],"target":[0,0,0],"fovy":4}"#, "fovy"),
        (r#"{"eye":[0,0,1],"target":[0,0,1]}"#, "different places"),
        (
            r#"{"view":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"projection":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}"#,
            "perspective",
        ),
    ] {
        folder.text("c.json", text);
        folder.run(&format!("render a.ply -o o.png {SMALL} --camera c.json")).fails(3, &[part]);
    }
    for (text, part) in [
        ("[water]\nspacin = 1.0", "expected one of `spacing`"),
        ("[water]\nmedium = 'mud'", "clear, pool, lake, ocean"),
        ("[water]\nrefraction = -1.0", "refraction"),
    ] {
        folder.text("s.toml", text);
        folder.run(&format!("render a.ply -o o.png {SMALL} --settings s.toml")).fails(3, &[part]);
    }
    for flag in ["--camera", "--settings", "--scene", "--environment"] {
        folder
            .run(&format!("render a.ply -o o.png {SIZE} {flag} none.json"))
            .fails(3, &["none.json"]);
    }
    folder.text("scene.json", r#"{"boxes":[{"centre":[0,0]}]}"#);
    folder
        .run(&format!("render a.ply -o o.png {SIZE} --scene scene.json"))
        .fails(3, &["scene.json"]);
    assert!(!folder.exists("o.png"));
}

#[test]
fn bad_command_lines_are_code_2() {
    let folder = Folder::new();
    folder.particles("a.ply", block(3));
    folder.run("render a.ply -o out.jpg").fails(2, &[".exr, .png or .mp4", "out.jpg"]);
    folder
        .run("render a.ply -o out.png --size 200000x10 --supersample 2")
        .fails(2, &["400000", "--supersample"]);
    folder.run("render a.ply -o out.png --sun 0,0,0").fails(2, &["--sun"]);
    for arguments in [
        "",
        "render",
        "render a.ply",
        "render a.ply -o o.png --size 0x3",
        "render a.ply -o o.png --thickness-level 4",
        "render a.ply -o o.png --supersample 3",
        "render a.ply -o o.png --shutter -1",
        "render a.ply -o o.png --shutter 1/0",
        "render a.ply -o o.png --aperture -0.1",
        "render a.ply -o o.png --focus 0",
        "render a.ply -o o.png --samples 257",
        "render a.ply -o o.png --radius -1",
        "render a.ply -o o.png --eye 0,0,1",
        "render a.ply -o o.png --rule fast",
        "render a.ply -o o.png --camera c.json --fov 20",
        "drown",
    ] {
        let run = folder.run(arguments);
        assert_eq!(run.0.status.code(), Some(2), "{arguments}: {}", run.stderr());
    }
    assert!(folder.run("--help").ok().stdout().contains("Exit codes"));
    assert!(folder.run("render --help").ok().stdout().contains("Exit codes"));
}

/// However its path is written: with another folder in front, through a link, or as a file of a fluid.
#[test]
fn no_input_is_written() {
    let folder = Folder::new();
    for name in ["f_1.ply", "f_2.ply", "oil_1.ply"] {
        folder.particles(name, block(3));
    }
    symlink("f_2.ply", folder.path("link_2.ply")).unwrap();
    folder.text("a.csv", "x,y,z\n0,0,0\n");
    folder.text("w.csv", "x,y,z\n0,0,0\n");
    folder.text("c.json", r#"{"eye":[0,0,3],"target":[0,0,0]}"#);
    folder.text("sky.exr", "a sky");
    folder.text("sky2.exr", "a sky");
    folder.text("sky.0001.exr", "a sky");
    folder.text("s.json", "");
    folder.text("w.toml", "[shore]\nweb = \"w.png\"\n");
    folder.text("w.png", "a web");
    let names =
        "f_1.ply f_2.ply oil_1.ply a.csv w.csv c.json sky.exr sky2.exr sky.0001.exr s.json w.png";
    let names: Vec<&str> = names.split(' ').collect();
    let read = || -> Vec<Vec<u8>> {
        names.iter().map(|name| std::fs::read(folder.path(name)).unwrap()).collect()
    };
    let before = read();
    let made = "--whitewater generate --write-whitewater";
    for (inputs, flag, said) in [
        ("f_*.ply", format!("{made} ./f_%d.ply"), "--write-whitewater: ./f_1.ply"),
        ("f_*.ply", format!("{made} link_%d.ply"), "--write-whitewater: link_2.ply"),
        ("f_1.ply --fluid oil_1.ply:honey", format!("{made} oil_1.ply"), "oil_1.ply"),
        ("a.csv", "--timings ./a.csv".into(), "--timings: ./a.csv"),
        ("f_1.ply --whitewater w.csv", "--timings w.csv".into(), "--timings: w.csv"),
        ("f_1.ply --camera c.json", "--trace c.json".into(), "--trace: c.json"),
    ] {
        let run = folder.run(&format!("render {inputs} -o o_%d.png {SMALL} {flag}"));
        run.fails(2, &[said, "is an input; name another file"]);
    }
    for (command, said) in [
        ("render f_1.ply -o sky.exr --environment ./sky.exr", "--output: sky.exr is an input"),
        ("render f_*.ply -o sky%d.exr --environment sky2.exr", "--output: sky2.exr is an input"),
        (
            "render f_*.ply -o sky.exr --environment sky.0001.exr",
            "--output: sky.0001.exr is an input",
        ),
        ("demo -o sky.exr --environment sky.exr", "--output: sky.exr is an input"),
        (
            "render --shore pool -o o.png --settings s.json --timings s.json",
            "--timings: s.json is an input",
        ),
        (
            "render --shore pool -o o.png --camera c.json --timings c.json",
            "--timings: c.json is an input",
        ),
        ("demo -o o.png --camera ./c.json --trace c.json", "--trace: c.json is an input"),
        ("render --shore c.json -o o.png --trace c.json", "--trace: c.json is an input"),
        ("render --bubbles c.json -o o.png --trace c.json", "--trace: c.json is an input"),
        ("render f_1.ply -o w.png --settings w.toml", "--output: w.png is an input"),
        ("render f_1.ply -o o.exr -o o.png -o o.exr", "--output: o.exr is named twice"),
        (
            "render f_1.ply -o o.png --timings t.json --trace t.json",
            "--trace: t.json is named twice",
        ),
    ] {
        folder.run(&format!("{command} {SIZE}")).fails(2, &[said, "name another file"]);
    }
    let pattern = folder.run("pattern w.png -o ./w.png");
    pattern.fails(2, &["--output: ./w.png is an input; name another file"]);
    assert!(read() == before);
}

/// Scenes without particles do not ignore options about particles.
#[test]
fn options_of_particles_need_particles() {
    let folder = Folder::new();
    for scene in ["--shore pool", "--bubbles one"] {
        for option in [
            "--radius 0.1",
            "--where a=1",
            "--unit cm",
            "--scale 2",
            "--up-axis z",
            "--join",
            "--set studio",
            "--write-whitewater w.ply",
        ] {
            let run = folder.run(&format!("render {scene} -o o.png {SIZE} {option}"));
            let (flag, scene) =
                (option.split(' ').next().unwrap(), &scene[..scene.find(' ').unwrap()]);
            run.fails(2, &[&format!("{flag}: expected particle files, found {scene} alone")]);
        }
    }
    assert!(!folder.exists("o.png"));
}

#[test]
fn no_device_is_code_4() {
    let folder = Folder::new();
    folder.particles("a.ply", block(3));
    let command = format!("render a.ply -o out.png {SMALL}");
    folder.run(&format!("{command} --device nosuch")).fails(4, &["nosuch", "there is"]);
    let nowhere = [("VK_DRIVER_FILES", "/nonexistent"), ("VK_ICD_FILENAMES", "/nonexistent")];
    folder.run_with(&command, &nowhere).fails(4, &["mesa-vulkan-drivers"]);
    // The loader finds no layers in these places.
    let bare = [("VK_LAYER_PATH", "/nonexistent"), ("VK_ADD_LAYER_PATH", "")];
    folder
        .run_with(&format!("{command} --validate"), &bare)
        .fails(4, &["VK_LAYER_KHRONOS_validation", "vulkan-validationlayers"]);
    assert_eq!(folder.files(), ["a.ply"]);
}

#[test]
fn outputs_that_cannot_be_written_are_code_5() {
    let folder = Folder::new();
    folder.particles("a.ply", block(3));
    folder
        .run(&format!("render a.ply -o none/out.png {SMALL}"))
        .fails(5, &["none/out.png", "make the folder"]);
    std::fs::create_dir(folder.path("dir.png")).unwrap();
    folder.run(&format!("render a.ply -o dir.png {SMALL}")).fails(5, &["directory"]);
    std::fs::create_dir(folder.path("locked")).unwrap();
    let locked = folder.path("locked");
    std::fs::set_permissions(&locked, PermissionsExt::from_mode(0o555)).unwrap();
    // Root may write anywhere.
    if std::fs::write(locked.join("probe"), "").is_err() {
        folder
            .run(&format!("render a.ply -o locked/out.png {SMALL}"))
            .fails(5, &["locked/out.png"]);
    } else {
        crate::skipped::skipped("a folder without permission; root may write anywhere");
    }
    folder
        .run(&format!("render a.ply -o out.png {SMALL} --timings none/t.csv"))
        .fails(5, &["none/t.csv"]);
    assert!(!folder.exists("out.png"));
}

#[test]
fn a_full_disk_is_code_5() {
    let folder = Folder::new();
    folder.particles("a.ply", block(3));
    for name in ["full.png", "full.exr", "full.csv"] {
        symlink("/dev/full", folder.path(name)).unwrap();
    }
    let command = format!("render a.ply {SMALL}");
    folder.run(&format!("{command} -o full.png")).fails(5, &["full.png", "space"]);
    folder.run(&format!("{command} -o full.exr")).fails(5, &["full.exr", "space"]);
    folder.run(&format!("{command} -o a.png --timings full.csv")).fails(5, &["full.csv", "space"]);
    assert_eq!(folder.files(), ["a.ply", "a.png", "full.csv", "full.exr", "full.png"]);
}

/// Commands that print a result, with standard output full, or closed by its reader.
#[test]
fn an_output_that_is_full_is_code_5_and_one_that_is_closed_none() {
    let folder = Folder::new();
    folder.particles("a.ply", block(3));
    folder.run(&format!("render a.ply -o a.png {SMALL}")).ok();
    folder.run(&format!("render a.ply -o b.png {SMALL} --sun 1,1,1")).ok();
    let bench = "bench --particles 64 --size 64x64 --frames 1 --warmup 0 --format";
    // A benchmark prints all formats by one function, so only the table is tested with a closed reader.
    let printing = [
        "info a.ply".to_string(),
        "info a.ply --json".to_string(),
        "compare a.png a.png".to_string(),
        "compare a.png a.png --flip".to_string(),
        format!("{bench} table"),
        format!("{bench} csv"),
        format!("{bench} json"),
    ];
    for command in &printing {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        folder.run_to(command, full).fails(5, &["standard output", "space"]);
        if command.starts_with("bench") && !command.ends_with("table") {
            continue;
        }
        let closed = || std::io::pipe().unwrap().1;
        let run = folder.run_to(command, closed()).ok();
        assert!(!run.stderr().contains("panicked"), "{command}: {}", run.stderr());
        // A closed standard error makes no difference either.
        let mut unheard = folder.command(command);
        let status = unheard.stdout(closed()).stderr(closed()).status().unwrap();
        assert_eq!(status.code(), Some(0), "{command}");
    }
    // The verdict is returned although nobody reads the list.
    folder.run_to("compare a.png b.png", std::io::pipe().unwrap().1).fails(1, &["RMSE"]);
}

#[test]
fn a_file_that_cannot_grow_leaves_nothing_half() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.particles("in/a.ply", block(3));
    folder.text("out/a.exr", "old");
    // The limit on file sizes simulates a disk that fills up while a picture is written.
    let limited = |picture: &str| {
        let run = format!("trap '' XFSZ; ulimit -f 8; exec \"$0\" render in/a.ply -o {picture}");
        std::process::Command::new("sh")
            .args(["-c", &run])
            .arg(env!("CARGO_BIN_EXE_whitewater"))
            .current_dir(folder.path(""))
            .output()
            .unwrap()
    };
    // Some drivers keep code or memory in files of their own (SwiftShader; Mesa 25's lavapipe) and do not survive the
    // limit: they end by a signal, though the picture fits.
    if limited("small.png --set none --size 16x16").status.code().is_none() {
        crate::skipped::skipped("the driver itself needs files that the limit forbids");
        return;
    }
    super::support::Run(limited("out/a.exr --set none --size 96x64")).fails(5, &["out/a.exr"]);
    assert_eq!(names(&folder.path("out")), ["a.exr"]);
    assert_eq!(std::fs::read(folder.path("out/a.exr")).unwrap(), b"old");
}

#[test]
fn an_interrupt_leaves_nothing_half() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("out")).unwrap();
    for frame in 0..200 {
        folder.particles(&format!("f_{frame}.ply"), block(3));
    }
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_whitewater"))
        .args(["render", "f_%d.ply", "-o", "out/a.exr", "--size", "320x180", "--set", "none"])
        .args(["--timings", "t.csv", "--trace", "t.json", "-o", "film.mp4"])
        .current_dir(folder.path(""))
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let began = std::time::Instant::now();
    while names(&folder.path("out")).len() < 3 && began.elapsed().as_secs() < 300 {
        std::thread::sleep(std::time::Duration::from_millis(7));
    }
    let id = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    for name in names(&folder.path("out")) {
        assert!(!name.starts_with('.'), "{name}");
        folder.picture(&format!("out/{name}"));
    }
    // A film contains the drawn frames, except those in flight when it was written.
    let drawn = names(&folder.path("out")).len() as u32;
    let (frames, _) = folder.film("film.mp4");
    assert!(frames + 2 >= drawn && frames <= drawn, "{frames} of {drawn}");
    // The measurements are kept.
    let times = std::fs::read_to_string(folder.path("t.csv")).unwrap();
    assert!(times.lines().any(|l| l.starts_with("1,composite,")), "{times}");
    let trace = std::fs::read_to_string(folder.path("t.json")).unwrap();
    let trace: serde_json::Value = serde_json::from_str(&trace).unwrap();
    assert!(trace["traceEvents"].as_array().is_some_and(|events| events.len() > 20));
}

/// Waits until the child has stopped. A signal to stop takes effect when a thread leaves the kernel, so a thread that
/// waits for the disk may still rename a file.
#[cfg(target_os = "linux")]
fn wait_until_stopped(child: &std::process::Child) {
    let tasks = format!("/proc/{}/task", child.id());
    let stopped = |task: std::fs::DirEntry| {
        // The state follows the name, which may itself contain a parenthesis.
        let stat = std::fs::read_to_string(task.path().join("stat")).unwrap_or_default();
        stat.rsplit_once(") ").is_none_or(|(_, rest)| rest.starts_with(['T', 'X', 'Z']))
    };
    while !std::fs::read_dir(&tasks).into_iter().flatten().flatten().all(stopped) {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
}

/// A run that is killed while it writes leaves an incomplete file. The next run removes it, but not while the first run
/// lives.
#[test]
#[cfg(target_os = "linux")] // signals that stop and go on
fn a_kill_leaves_a_file_to_the_next_run() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.particles("a.ply", block(3));
    // The size that is killed is slow to write; the other is as small as possible.
    let [render, again] = ["640x360", "96x64"]
        .map(|size| format!("render a.ply -o out/a.exr --set none --size {size}"));
    let hidden = || names(&folder.path("out")).into_iter().find(|name| name.starts_with('.'));
    let signal = |child: &std::process::Child, signal: &str| {
        let mut kill = std::process::Command::new("kill");
        assert!(kill.args([signal, &child.id().to_string()]).status().unwrap().success());
    };
    for _ in 0..20 {
        let mut child =
            folder.command(&render).stderr(std::process::Stdio::null()).spawn().unwrap();
        while child.try_wait().unwrap().is_none() {
            if hidden().is_none() {
                std::thread::sleep(std::time::Duration::from_micros(300));
                continue;
            }
            signal(&child, "-STOP");
            wait_until_stopped(&child);
            // It may also be the file that is created and removed at the start to test that the folder is writable.
            // Until a file is locked, other runs treat it as a leftover.
            let locked = |name: &String| {
                let file = std::fs::File::open(folder.path(&format!("out/{name}"))).unwrap();
                matches!(FileExt::try_lock(&file), Err(TryLockError::WouldBlock))
            };
            let Some(name) = hidden().filter(locked) else {
                signal(&child, "-CONT");
                continue;
            };
            folder.run(&again).ok();
            assert_eq!(names(&folder.path("out")), [name.as_str(), "a.exr"]);
            signal(&child, "-KILL");
            child.wait().unwrap();
            assert_eq!(hidden(), Some(name));
            folder.run(&again).ok();
            assert_eq!(names(&folder.path("out")), ["a.exr"]);
            return;
        }
    }
    panic!("no run was stopped while it wrote");
}
