//! What `plumb slurm` writes, run by a real Slurm.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

use super::cluster::Cluster;
use super::desk::{Desk, LIT, Ran};

#[allow(dead_code, reason = "only the driver's name is wanted")]
#[path = "../common/drivers.rs"]
mod drivers;

/// Parts of the picture.
const PARTS: u32 = 16;

/// A cluster, and a folder that its one node sees.
struct Site {
    cluster: Cluster,
    desk: Desk,
}

impl Site {
    fn new() -> Option<Self> {
        let cluster = Cluster::start()?;
        let desk = Desk::new();
        desk.write("lit.txt", LIT);
        Some(Self { cluster, desk })
    }

    fn command(&self, program: &str, args: &[&str]) -> Command {
        let mut command = self.cluster.command(program);
        command.args(args).current_dir(self.desk.folder.path());
        command
    }

    #[track_caller]
    fn shell(&self, line: &str) -> Ran {
        Ran::new(
            &[line],
            self.command("bash", &["-c", line]).output().unwrap(),
        )
    }

    /// What jobs have said.
    fn logs(&self) -> String {
        let names = self.desk.names();
        let logs = names.iter().filter(|name| name.starts_with("slurm-"));
        logs.map(|name| String::from_utf8_lossy(&self.desk.read(name)).into_owned())
            .collect()
    }

    fn part(&self, number: u32) -> std::path::PathBuf {
        self.desk.path(&format!(
            "big.png.parts/big.{number:02}-of-{PARTS}.plumbpart"
        ))
    }
}

/// Stands for nodes of three kinds, in turns, and for what may go wrong on one, the first time.
const NODE: &str = r#"#!/bin/bash
part() { printf 'big.png.parts/big.%02d-of-16.plumbpart' "$SLURM_ARRAY_TASK_ID"; }
if [ "$1" != render ]; then exec PLUMB "$@"; fi
if [ ! -e mended ]; then
    case $SLURM_ARRAY_TASK_ID in
        3) exec timeout -s KILL 0.1 PLUMB "$@" --backend=cpu --samples=4096 ;;
        7) head -c 5000 /dev/urandom > "$(part)"; exit ;;
        9) trap '' XFSZ; ulimit -f 1 ;;
    esac
fi
case $((SLURM_ARRAY_TASK_ID % 3)) in
    0) exec PLUMB "$@" --backend=cpu ;;
    1) VK_DRIVER_FILES=SECOND exec PLUMB "$@" --backend=gpu ;;
    2) exec PLUMB "$@" --backend=gpu ;;
esac
"#;

const OPTIONS: [&str; 4] = ["--size", "160x120", "--max-path", "40"];

/// Sixteen parts of a picture, made by unlike nodes in turns. Whatever befalls them, what is submitted again mends it,
/// and the picture's file is the one that is rendered in one piece.
#[test]
fn a_cluster_makes_the_same_file_whatever_happens() {
    let Some(site) = Site::new() else { return };
    let desk = &site.desk;
    let whole = [
        &["render", "lit.txt", "-o", "whole.png", "--backend", "cpu"][..],
        &OPTIONS,
    ]
    .concat();
    desk.run(&whole).ends(0);
    let slurm = [
        &[
            "slurm",
            "lit.txt",
            "-o",
            "big.png",
            "--parts",
            "16",
            "--retries",
            "0",
            "--submit",
        ][..],
        &OPTIONS,
    ]
    .concat();
    let script = desk.run(&slurm[..8]).ends(0).text();
    assert!(script.contains("\n#SBATCH --array=1-16\n"), "{script}");
    // Here as there, but its nodes are of several kinds.
    let script = desk.run(&[&slurm[..8], &OPTIONS].concat()).ends(0).text();
    let plumb = env!("CARGO_BIN_EXE_plumb");
    let second = drivers::second_driver();
    let node = NODE
        .replace("PLUMB", plumb)
        .replace("SECOND", second.to_str().unwrap());
    desk.write("node", &node);
    fs::set_permissions(desk.path("node"), fs::Permissions::from_mode(0o755)).unwrap();
    let (head, rest) = script.split_once("\nplumb=").unwrap();
    let (_, rest) = rest.split_once('\n').unwrap();
    desk.write("big.sh", &format!("{head}\nplumb=./node\n{rest}"));

    let told = site.shell("bash big.sh").ends(0).text();
    assert!(told.starts_with("parts 1-16: job "), "{told}");
    site.cluster.settle();
    // The join has told what is missing, and made no picture.
    assert!(!desk.path("big.png").exists(), "{}", site.logs());
    assert!(site.logs().contains("\n3,7,9\n"), "{}", site.logs());
    let check = ["join", "big.png", "--check"];
    assert_eq!(desk.run(&check).ends(1).text(), "3,7,9\n");

    // Parts are cut short, have a bit flipped, are there twice.
    let bytes = fs::read(site.part(1)).unwrap();
    fs::write(site.part(1), &bytes[..bytes.len() - 1]).unwrap();
    let mut bytes = fs::read(site.part(11)).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(site.part(11), bytes).unwrap();
    fs::copy(site.part(13), site.part(12)).unwrap();
    let told = desk.run(&check).ends(1);
    assert_eq!(told.text(), "1,3,7,9,11-12\n");
    for word in [
        "cut short",
        "no part of a picture",
        "the hash of its rows",
        "part 13 of 16",
    ] {
        assert!(told.stderr.contains(word), "{word}: {}", told.stderr);
    }
    // One is of another scene, and only who has the scene knows which one is wanted.
    let other = [
        "render",
        "room.txt",
        "-o",
        "big.png",
        "--part",
        "5/16",
        "--backend",
        "cpu",
    ];
    desk.run(&[&other[..], &OPTIONS].concat()).ends(0);
    let told = desk.run(&check).ends(1);
    assert_eq!(told.text(), "1-16\n");
    assert!(
        told.stderr.contains("parts of 2 pictures"),
        "{}",
        told.stderr
    );

    desk.write("mended", "");
    let told = site.shell("bash big.sh missing").ends(0).text();
    assert!(told.starts_with("parts 1-16: job "), "{told}");
    site.cluster.settle();
    assert!(desk.path("big.png").exists(), "{}", site.logs());
    assert_eq!(desk.read("big.png"), desk.read("whole.png"));
    assert_eq!(desk.run(&check).ends(0).text(), "");
    // What was right was not made again.
    assert_eq!(
        site.logs().matches("is there and right").count(),
        9,
        "{}",
        site.logs()
    );

    // Where the parts are gone and the picture is there, nothing is made again.
    fs::rename(desk.path("big.png.parts"), desk.path("kept")).unwrap();
    let told = site.shell("bash big.sh missing").ends(0).text();
    assert!(told.starts_with("nothing is missing"), "{told}");
    fs::rename(desk.path("kept"), desk.path("big.png.parts")).unwrap();

    // A task that fails goes back into the queue, where it is asked for, and it alone: the last one's number is the
    // array's.
    fs::remove_file(desk.path("mended")).unwrap();
    fs::remove_file(site.part(5)).unwrap();
    fs::remove_file(site.part(9)).unwrap();
    desk.write(
        "big.sh",
        &desk_text(desk, "big.sh").replace("-lt 0", "-lt 1"),
    );
    site.shell(
        "sbatch --array=$(PLUMB join big.png --check) big.sh"
            .replace("PLUMB", plumb)
            .as_str(),
    )
    .ends(0);
    let jobs = || site.shell("scontrol show job -o").text();
    let restarts = |task: u32, restarts: u32| {
        let (task, restarts) = (
            format!(" ArrayTaskId={task} "),
            format!(" Restarts={restarts} "),
        );
        let of_task = |line: &&str| line.contains(&task) && line.contains(&restarts);
        jobs().lines().filter(of_task).count()
    };
    let queued = (0..100).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(100));
        restarts(9, 1) == 1
    });
    assert!(queued, "{}{}", jobs(), site.logs());
    assert_eq!(restarts(5, 1), 0, "{}{}", jobs(), site.logs());
    site.shell("scancel --user=root").ends(0);
}

fn desk_text(desk: &Desk, name: &str) -> String {
    String::from_utf8(desk.read(name)).unwrap()
}

/// A picture of each scene, more of them than tasks.
#[test]
fn a_cluster_makes_frames() {
    let Some(site) = Site::new() else { return };
    let desk = &site.desk;
    fs::create_dir(desk.path("a film")).unwrap();
    for name in ["it's one.txt", "two.txt", "three.txt", "$four.txt"] {
        desk.write(name, LIT);
    }
    let scenes = ["it's one.txt", "two.txt", "three.txt", "$four.txt"];
    let options = [
        "-o",
        "a film/{}.ppm",
        "--frames",
        "--parts",
        "3",
        "--backend",
        "cpu",
        "--submit",
        "--",
        "--export=NONE",
    ];
    let mut command = desk.command(&[&["slurm"][..], &scenes, &options].concat());
    site.cluster.known_to(&mut command);
    let submitted = command.output().unwrap();
    assert!(submitted.status.success(), "{submitted:?}");
    site.cluster.settle();
    desk.run(&["render", "two.txt", "-o", "whole.ppm", "--backend", "cpu"])
        .ends(0);
    for picture in ["it's one.ppm", "two.ppm", "three.ppm", "$four.ppm"] {
        let path = desk.path("a film").join(picture);
        let made = fs::read(path).unwrap_or_else(|_| panic!("{picture}: {}", site.logs()));
        assert_eq!(made, desk.read("whole.ppm"), "{picture}");
    }
    assert!(
        site.shell("bash frames.sh missing")
            .ends(0)
            .text()
            .contains("no picture is missing")
    );
    fs::remove_file(desk.path("a film/$four.ppm")).unwrap();
    let told = site.shell("bash frames.sh missing").ends(0).text();
    assert!(
        told.starts_with("missing: a film/$four.ppm\ntasks 1: job "),
        "{told}"
    );
    site.cluster.settle();
    assert!(desk.path("a film/$four.ppm").exists(), "{}", site.logs());
    // The same task has another picture, which was there.
    assert_eq!(
        site.logs().matches("a film/it's one.ppm: ").count(),
        1,
        "{}",
        site.logs()
    );
}

/// A task that fails goes back into the queue, and it alone: by its own number in the array, as the job's number may be
/// that of all. So does one of a node that does not see the folder, which would take all tasks otherwise.
#[test]
fn a_task_that_fails_is_put_back_alone() {
    let desk = Desk::new();
    fs::create_dir(desk.path("bin")).unwrap();
    desk.write("bin/scontrol", "#!/bin/sh\necho \"$@\"\n");
    let scontrol = desk.path("bin/scontrol");
    fs::set_permissions(scontrol, fs::Permissions::from_mode(0o755)).unwrap();
    let task = |script: &str, restarts: &str| {
        let mut shell = Command::new("bash");
        shell.args(["-c", script]);
        shell.env(
            "PATH",
            format!("{}:/usr/bin:/bin", desk.path("bin").display()),
        );
        let slurm = ["JOB_ID", "ARRAY_JOB_ID", "ARRAY_TASK_ID", "RESTART_COUNT"];
        for (name, value) in slurm.iter().zip(["7", "7", "2", restarts]) {
            shell.env(format!("SLURM_{name}"), value);
        }
        Ran::new(&["task"], shell.output().unwrap())
    };
    let here = format!("cd {} ||", desk.folder.path().display());
    desk.write("other.txt", super::desk::ROOM);
    for what in [
        &["room.txt", "-o", "a.png", "--parts", "2"][..],
        &["other.txt", "room.txt", "-o", "{}.png", "--frames"],
    ] {
        let args = [&["slurm"][..], what, &["--backend", "cpu"]].concat();
        let script = desk.run(&args).ends(0).text();
        assert_eq!(task(&script, "0").ends(0).text(), "");
        let lost = script.replace(&here, "cd /nowhere ||");
        assert_ne!(lost, script);
        let failed = script.replace("room.txt", "gone.txt");
        for script in [lost, failed] {
            assert_eq!(task(&script, "1").ends(2).text(), "requeue 7_2\n");
            // Two more tries are enough.
            assert_eq!(task(&script, "2").ends(2).text(), "");
        }
    }
}

/// What would fail on every node fails before anything is submitted; what sbatch refuses is told as that.
#[test]
fn what_cannot_be_is_told_at_once() {
    let desk = Desk::new();
    let slurm = |more: &[&str]| desk.run(&[&["slurm", "room.txt"][..], more].concat());
    slurm(&["-o", "nowhere/a.png", "--parts", "2"])
        .fails_with(&["the folder nowhere does not exist"]);
    slurm(&["-o", "a.png", "--parts", "2", "--parts-in", "nowhere/parts"])
        .fails_with(&["the folder nowhere does not exist"]);
    slurm(&["-o", "nowhere/{}.png", "--frames"]).fails_with(&["the folder nowhere does not exist"]);
    slurm(&["-o", "a.png", "--frames"]).fails_with(&["'film/{}.png'"]);
    // Pictures are named as `plumb render` names them.
    fs::create_dir(desk.path("film")).unwrap();
    for (output, named) in [("film/b-{}.png", "b-room.png"), ("film", "room.ppm")] {
        let picture = slurm(&["-o", output, "--parts", "2"]).ends(0).text();
        for line in [
            format!("picture=./film/{named}\n"),
            format!("folder=film/{named}.parts\n"),
        ] {
            assert!(picture.contains(&line), "{line}{picture}");
        }
        let film = slurm(&["-o", output, "--frames"]).ends(0).text();
        let line = format!("pictures=(\nfilm/{named}\n)");
        assert!(film.contains(&line), "{line}{film}");
        assert!(film.contains(&format!("--output={output}")), "{film}");
    }
    let told = slurm(&["-o", "a.exr", "--parts", "2", "--gpus-per-task", "1"]).ends(0);
    assert!(
        told.stderr.contains("GPUs will have nothing to do"),
        "{}",
        told.stderr
    );

    fs::create_dir(desk.path("bin")).unwrap();
    let sbatch = |text: &str| {
        desk.write("bin/sbatch", text);
        let path = desk.path("bin/sbatch");
        fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    };
    let submit = |parts: &str| {
        let args = ["slurm", "room.txt", "-o", "a.png", "--submit", "--parts"];
        let mut command = desk.command(&[&args[..], &[parts]].concat());
        command.env(
            "PATH",
            format!("{}:/usr/bin:/bin", desk.path("bin").display()),
        );
        Ran::new(&args, command.output().unwrap())
    };
    sbatch("#!/bin/sh\necho no such partition >&2\nexit 1\n");
    let refused = submit("2").ends(2).stderr;
    assert!(refused.contains("refused an option"), "{refused}");
    assert!(!refused.contains("missing"), "{refused}");
    sbatch("#!/bin/sh\necho 7\n");
    let told = submit("2").ends(0).stderr;
    assert!(told.contains("the script is a.sh\n"), "{told}");
    assert!(told.contains("`bash a.sh missing`"), "{told}");
    // Another picture may have had a script of that name.
    let told = submit("3").ends(0).stderr;
    assert!(told.contains("in place of another one"), "{told}");
}
