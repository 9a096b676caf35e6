//! A real Slurm on this machine, of one node with two slots: its daemons are started as root, in a folder of their own,
//! and end with the test.

use std::fs;
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Set where there can be no Slurm, by who knows that: the tests that need one say so and do nothing.
const WITHOUT: &str = "PLUMB_WITHOUT_SLURM";

/// Slurm, as long as it is held.
pub(crate) struct Cluster {
    folder: TempDir,
    daemons: Vec<Child>,
}

impl Cluster {
    /// Starts it. None only where somebody has said that there is no Slurm.
    pub(crate) fn start() -> Option<Self> {
        if std::env::var_os(WITHOUT).is_some() {
            say("NO SLURM HERE: what `plumb slurm` writes is NOT TESTED on a cluster");
            return None;
        }
        let root = Command::new("id").arg("-u").output().unwrap().stdout == b"0\n";
        let there = |name: &str| {
            ["/usr/sbin", "/usr/bin"]
                .iter()
                .any(|dir| Path::new(dir).join(name).exists())
        };
        let all = ["munged", "slurmctld", "slurmd", "sbatch"]
            .into_iter()
            .all(there);
        assert!(
            root && all,
            "Slurm is tested by root, who has it (Debian, Ubuntu: apt-get install slurm-wlm munge); where that cannot \
             be, set {WITHOUT}=1"
        );
        let folder = tempfile::tempdir().unwrap();
        // Who reads a secret beside it may not be able to change the folder.
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
        let mut cluster = Self {
            folder,
            daemons: Vec::new(),
        };
        cluster.configure();
        let path = |name: &str| {
            format!(
                "--{}={}",
                name.replace('.', "-"),
                cluster.path(name).display()
            )
        };
        let munge: Vec<String> = ["key-file", "seed-file", "pid-file", "log-file"]
            .map(path)
            .into();
        let socket = format!("--socket={}", cluster.path("munge").display());
        cluster.daemon(
            "munged",
            &[
                &["--foreground".into(), "--force".into(), socket][..],
                &munge,
            ]
            .concat(),
        );
        cluster.wait("munged", |cluster| cluster.path("munge").exists());
        cluster.daemon("slurmctld", &["-D".into(), "-i".into()]);
        cluster.daemon("slurmd", &["-D".into()]);
        cluster.wait("slurmd", |cluster| {
            let nodes = cluster
                .command("sinfo")
                .args(["-h", "-o", "%T"])
                .output()
                .unwrap();
            nodes.stdout.starts_with(b"idle")
        });
        Some(cluster)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn configure(&self) {
        fs::write(self.path("key-file"), [7; 1024]).unwrap();
        fs::set_permissions(self.path("key-file"), fs::Permissions::from_mode(0o400)).unwrap();
        for folder in ["state", "spool"] {
            fs::create_dir(self.path(folder)).unwrap();
        }
        let free: Vec<_> = (0..2)
            .map(|_| TcpListener::bind("127.0.0.1:0").unwrap())
            .collect();
        let port = |i: usize| free[i].local_addr().unwrap().port();
        let host =
            String::from_utf8(Command::new("uname").arg("-n").output().unwrap().stdout).unwrap();
        let (host, here) = (
            host.trim().split('.').next().unwrap(),
            self.folder.path().display(),
        );
        let text = format!(
            "ClusterName=plumb\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser=root\nSlurmdUser=root\n\
             SlurmctldPort={}\nSlurmdPort={}\nAuthType=auth/munge\nAuthInfo=socket={here}/munge\n\
             ProctrackType=proctrack/pgid\nTaskPlugin=task/none\nSelectType=select/cons_tres\n\
             SelectTypeParameters=CR_CPU\nReturnToService=2\nKillWait=2\nMpiDefault=none\n\
             SlurmdParameters=config_overrides\nSchedulerParameters=batch_sched_delay=0,sched_min_interval=10000\n\
             StateSaveLocation={here}/state\nSlurmdSpoolDir={here}/spool\n\
             SlurmctldPidFile={here}/ctld.pid\nSlurmdPidFile={here}/d.pid\n\
             SlurmctldLogFile={here}/slurmctld.log\nSlurmdLogFile={here}/slurmd.log\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n\
             PartitionName=all Nodes=ALL Default=YES MaxTime=10 State=UP\n",
            port(0),
            port(1)
        );
        fs::write(self.path("slurm.conf"), text).unwrap();
    }

    fn daemon(&mut self, name: &str, args: &[String]) {
        let said = fs::File::create(self.path(&format!("{name}.said"))).unwrap();
        let mut command = self.command(&format!("/usr/sbin/{name}"));
        command
            .args(args)
            .stdin(Stdio::null())
            .stdout(said.try_clone().unwrap())
            .stderr(said);
        self.daemons.push(command.spawn().unwrap());
    }

    fn wait(&self, what: &str, done: impl Fn(&Self) -> bool) {
        let end = Instant::now() + Duration::from_secs(60);
        while !done(self) {
            assert!(Instant::now() < end, "{what}: {}", self.said());
            thread::sleep(Duration::from_millis(50));
        }
    }

    /// All that the daemons have said.
    fn said(&self) -> String {
        let files = fs::read_dir(self.folder.path()).unwrap();
        let paths = files
            .map(|file| file.unwrap().path())
            .filter(|path| path.is_file());
        let texts = paths.map(|path| {
            format!(
                "{}:\n{}\n",
                path.display(),
                fs::read_to_string(&path).unwrap_or_default()
            )
        });
        texts.collect()
    }

    /// A program that knows this Slurm.
    pub(crate) fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        self.known_to(&mut command);
        command
    }

    /// Has a program know this Slurm.
    pub(crate) fn known_to(&self, command: &mut Command) {
        command.env("SLURM_CONF", self.path("slurm.conf"));
    }

    /// Waits until no job is left.
    pub(crate) fn settle(&self) {
        self.wait("jobs do not end", |cluster| cluster.has_no_jobs().unwrap());
    }

    /// Whether no job is left; none if Slurm does not answer.
    fn has_no_jobs(&self) -> Option<bool> {
        let queue = self.command("squeue").args(["-h"]).output().ok()?;
        queue.status.success().then_some(queue.stdout.is_empty())
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        // Jobs of a test that failed.
        let _ = self
            .command("scancel")
            .args(["--user=root", "--signal=KILL"])
            .status();
        // A step that finds no daemon to tell its end to would wait for one for ever.
        let end = Instant::now() + Duration::from_secs(10);
        while Instant::now() < end && self.has_no_jobs() == Some(false) {
            thread::sleep(Duration::from_millis(50));
        }
        for daemon in self.daemons.iter_mut().rev() {
            // One that has ended by itself is as good.
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

/// Says something that is read whether the test passes or not.
fn say(text: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "\n*** {text} ***\n");
}
