//! A thousand files, fifty of them broken, within a budget.

use std::process::Stdio;

use super::*;

/// Memory that the processes of a tree hold now, in bytes, as the system counts it.
#[cfg(target_os = "linux")]
fn memory_of_tree(root: u32) -> u64 {
    let field = |pid: u32, file: &str, name: &str| {
        let text = std::fs::read_to_string(format!("/proc/{pid}/{file}")).unwrap_or_default();
        let line = text.lines().find_map(|l| l.strip_prefix(name)).map(str::to_owned);
        line.and_then(|l| l.trim_end_matches("kB").trim().parse::<u64>().ok()).unwrap_or(0)
    };
    let mut pids = vec![root];
    let mut at = 0;
    while let Some(&pid) = pids.get(at) {
        for task in std::fs::read_dir(format!("/proc/{pid}/task")).into_iter().flatten().flatten() {
            let children = std::fs::read_to_string(task.path().join("children")).unwrap_or_default();
            pids.extend(children.split_whitespace().filter_map(|c| c.parse::<u32>().ok()));
        }
        at += 1;
    }
    // Shared pages count once.
    pids.into_iter().map(|pid| field(pid, "smaps_rollup", "Pss:") * 1024).sum()
}

#[cfg(target_os = "linux")]
#[test]
fn a_thousand_files_with_fifty_broken_ones() {
    const BUDGET: u64 = 300 << 20;
    let desk = Desk::new();
    let mut bad = Vec::new();
    for i in 0..1000usize {
        let (bytes, ending) = if i % 2 == 0 { (small_nef(), "nef") } else { (small_dng(), "dng") };
        let name = format!("in/{}/{i:04}.{ending}", i / 250);
        if i % 20 == 7 {
            bad.push(name.clone());
            // Three ways to be broken.
            match i % 3 {
                0 => desk.put(&name, &bytes[..bytes.len() / 3]),
                1 => desk.put(&name, "no raw file"),
                _ => desk.put(&name, [bytes[..8].to_vec(), vec![0xff; 3000]].concat()),
            }
        } else {
            desk.put(&name, bytes);
        }
    }
    assert_eq!(bad.len(), 50);
    let mut command =
        desk.command(&["batch", "in", "-o", "out", "--memory", "300M", "--jobs", "3", "--json"]);
    let out = std::fs::File::create(desk.path("lines")).unwrap();
    let err = std::fs::File::create(desk.path("words")).unwrap();
    let mut child = command.stdout(Stdio::from(out)).stderr(Stdio::from(err)).spawn().unwrap();
    let mut peak = 0;
    let code = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status.code();
        }
        peak = peak.max(memory_of_tree(child.id()));
        std::thread::sleep(Duration::from_millis(10));
    };
    let text = |name: &str| String::from_utf8(desk.read(name)).unwrap();
    let run = Run { code: code.unwrap(), out: text("lines"), err: text("words") };
    assert_eq!((run.code, summary(&run)), (1, [950, 0, 50, 0]), "{}", run.err);
    for name in &bad {
        assert_eq!(run.err.matches(&format!("error: {name}: ")).count(), 1, "{name}");
    }
    assert!(peak > 0 && peak < BUDGET, "{} MB", peak >> 20);
    eprintln!("peak memory of all processes: {} MB", peak >> 20);

    assert!(desk.left_over().is_empty(), "{:?}", desk.left_over());
    let names = desk.outputs();
    assert_eq!(names.len(), 950);
    desk.develop(&["in/0/0000.nef", "-o", "nef.jpg"]);
    desk.develop(&["in/0/0001.dng", "-o", "dng.jpg"]);
    let right = [desk.read("nef.jpg"), desk.read("dng.jpg")];
    for name in names {
        let number: usize = name[2..6].parse().unwrap();
        assert_eq!(desk.read(&format!("out/{name}")), right[number % 2], "{name}");
    }
}

/// Every format and depth: a worker holds no more than it said.
#[cfg(target_os = "linux")]
#[test]
fn workers_hold_no_more_memory_than_they_say() {
    let desk = Desk::new();
    let size = Size { width: 2008, height: 1508 };
    let capture = expose(&Scene::gradient(size), &Camera::nikon_d750(), &Exposure::default());
    desk.put("in/a.nef", nef::write(&capture, nef::Storage::Lossless).unwrap());
    let capture = expose(&Scene::gradient(size), &Camera::simulated_one(), &Exposure::default());
    desk.put("in/b.dng", dng::write(&capture, dng::Storage::Uncompressed));
    for (format, bits) in
        [("jpeg", "8"), ("png", "8"), ("png", "16"), ("tiff", "8"), ("tiff", "16"), ("tiff", "32")]
            .into_iter()
            .chain([("webp", "8"), ("avif", "8"), ("exr", "32"), ("jxl", "8"), ("jxl", "16"), ("dng", "16")])
    {
        assert_holds_what_it_says(&desk, "in", &["--format", format, "--bits", bits]);
    }
    // Light above white.
    for format in ["jpeg", "avif"] {
        assert_holds_what_it_says(&desk, "in", &["--format", format, "--hdr", "2"]);
    }
    // And where noise is told by likeness, which looks at more.
    let exposure = Exposure { stops: -4.0, noise: Some(1), ..Exposure::default() };
    let capture = expose(&Scene::gradient(size), &Camera::simulated_one(), &exposure);
    desk.put("noisy/a.dng", dng::write(&capture, dng::Storage::Uncompressed));
    assert_holds_what_it_says(&desk, "noisy", &["--denoise", "best"]);
}

#[cfg(target_os = "linux")]
fn assert_holds_what_it_says(desk: &Desk, folder: &str, settings: &[&str]) {
    let out = format!("out{}", settings.concat());
    let run =
        desk.run(&[&["batch", folder, "-o", &out, "--json", "--redo", "--jobs", "1"], settings].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let last = events(&run, "summary").pop().unwrap();
    let number = |name: &str| last[name].as_u64().unwrap();
    let (held, said) = (number("peak_worker_memory"), number("estimated_worker_memory"));
    eprintln!("{settings:?}: {} MB of {} MB", held >> 20, said >> 20);
    assert!(held > 0 && held <= said, "{settings:?}: {} MB of {} MB", held >> 20, said >> 20);
}
