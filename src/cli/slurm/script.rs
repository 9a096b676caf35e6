//! The text of a job script.

use std::ffi::{OsStr, OsString};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::quote::{line, quoted};
use crate::cli::SOFTWARE;

/// The line that tells our scripts from others.
const OURS: &str = "# Written by plumb";

/// Whether a file is a script of ours.
pub(super) fn is_ours(text: &[u8]) -> bool {
    let mut lines = text.split(|byte| *byte == b'\n');
    lines.any(|line| line.starts_with(OURS.as_bytes()))
}

/// What the cluster makes.
pub(super) enum What {
    /// A picture in parts.
    Parts {
        scene: PathBuf,
        output: PathBuf,
        folder: PathBuf,
        parts: u32,
        remove: bool,
    },
    /// A picture of each scene, shared among so many tasks.
    Frames {
        pictures: Vec<(PathBuf, PathBuf)>,
        /// What names them all.
        output: PathBuf,
        tasks: u32,
    },
}

impl What {
    /// The picture, or what names them all.
    pub(super) fn output(&self) -> &Path {
        let (Self::Parts { output, .. } | Self::Frames { output, .. }) = self;
        output
    }
}

/// A job script.
pub(super) struct Script {
    /// The job's name.
    pub(super) name: String,
    /// The program.
    pub(super) plumb: PathBuf,
    /// Where it runs.
    pub(super) folder: PathBuf,
    /// Options of rendering.
    pub(super) options: Vec<OsString>,
    /// Whether Slurm says how many threads there are.
    pub(super) threads: bool,
    pub(super) gpus: Option<u32>,
    pub(super) at_once: Option<u32>,
    pub(super) retries: u32,
    /// Options of sbatch.
    pub(super) sbatch: Vec<OsString>,
    pub(super) what: What,
}

impl Script {
    fn tasks(&self) -> u32 {
        match self.what {
            What::Parts { parts, .. } => parts,
            What::Frames { tasks, .. } => tasks,
        }
    }

    /// How many tasks run at the same time, as an array has it.
    fn at_once(&self) -> String {
        self.at_once
            .map(|tasks| format!("%{tasks}"))
            .unwrap_or_default()
    }

    /// The text.
    pub(super) fn text(&self) -> Vec<u8> {
        let mut text = self.head();
        let mut add = |more: &[u8]| text.extend(more);
        let word = |path: &OsStr| quoted(path);
        add(b"script=$(realpath \"$0\")\ncode=0\ncd ");
        add(&word(self.folder.as_os_str()));
        add(b" || code=2\nplumb=");
        add(&word(self.plumb.as_os_str()));
        add(format!("\nat_once={}\n", self.at_once()).as_bytes());
        add(b"# For the job that joins, and for nothing else: the lines above are for the tasks.\noptions=(");
        add(&line(self.sbatch.iter().map(OsString::as_os_str)));
        add(b")\n\n");
        match &self.what {
            What::Parts { .. } => add(&self.parts()),
            What::Frames {
                pictures,
                output,
                tasks,
            } => {
                add(&lists(pictures, *tasks));
                add(&self.frames(output));
            }
        }
        text
    }

    /// What Slurm and people read.
    fn head(&self) -> Vec<u8> {
        let mut text = Vec::new();
        let (name, tasks) = (&self.name, self.tasks());
        let mut lines = vec![
            format!("--job-name={name}"),
            format!("--array=1-{tasks}{}", self.at_once()),
            "--requeue".into(),
            "--open-mode=append".into(),
        ];
        if let Some(gpus) = self.gpus {
            lines.extend(["--ntasks=1".into(), format!("--gpus-per-task={gpus}")]);
        }
        text.extend(b"#!/bin/bash\n");
        for option in lines
            .iter()
            .map(OsStr::new)
            .chain(self.sbatch.iter().map(OsString::as_os_str))
        {
            text.extend(b"#SBATCH ");
            text.extend(quoted(option));
            text.push(b'\n');
        }
        let (what, missing) = match self.what {
            What::Parts { parts, .. } => (
                format!("a picture in {parts} parts, and then joined"),
                "missing or damaged",
            ),
            What::Frames {
                ref pictures,
                tasks,
                ..
            } => (
                format!("{} pictures, by {tasks} tasks", pictures.len()),
                "missing",
            ),
        };
        // Where writing into a text fails there is no memory either.
        let _ = write!(
            text,
            "#\n{OURS} ({SOFTWARE}): {what}. docs/CLUSTER.md tells more.\n#\n\
             #   bash THIS            submits all of it\n\
             #   bash THIS missing    when it has ended, submits what is {missing}, and nothing else\n\n"
        );
        text
    }

    /// The words that render, but for what is rendered.
    fn render_options(&self) -> Vec<u8> {
        let mut options = line(self.options.iter().map(OsString::as_os_str));
        if self.threads {
            // As many as Slurm has given; it may not keep a task from taking more.
            options.extend(br#" --threads="${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-1}}""#);
        }
        options
    }

    /// Puts a task that failed back into the queue.
    fn again(&self) -> String {
        let retries = self.retries;
        format!(
            r#"    # 1 is an answer, not a failure. Another try may be on another node.
    if [ "$code" -gt 1 ] && [ "${{SLURM_RESTART_COUNT:-0}}" -lt {retries} ]; then
        # The last task's own job number is that of the whole array.
        scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
    fi
    exit "$code"
fi
[ "$code" = 0 ] || exit "$code"
"#
        )
    }

    fn parts(&self) -> Vec<u8> {
        let What::Parts {
            scene,
            output,
            folder,
            parts,
            remove,
        } = &self.what
        else {
            return Vec::new();
        };
        let mut in_folder = OsString::from("--parts-in=");
        in_folder.push(folder);
        let mut joined = OsString::from("./");
        // A name that begins with a dash is a name.
        if output.is_absolute() {
            joined.clear();
        }
        joined.push(output);
        let join: [&OsStr; 4] = [
            "join".as_ref(),
            &joined,
            &in_folder,
            &OsString::from(format!("--parts={parts}")),
        ];
        let mut text = Vec::new();
        let mut add = |more: &[u8]| text.extend(more);
        add(TASK.as_bytes());
        add(b"    [ \"$code\" != 0 ] || \"$plumb\" render ");
        add(&quoted(scene.as_os_str()));
        add(b" -o ");
        add(&quoted(&joined));
        add(b" ");
        add(&quoted(&in_folder));
        add(b" ");
        add(&self.render_options());
        add(
            format!(" \\\n        --part=\"$SLURM_ARRAY_TASK_ID/{parts}\" || code=$?\n").as_bytes(),
        );
        add(self.again().as_bytes());
        add(b"\nparts=");
        add(format!("1-{parts}\n").as_bytes());
        add(b"join=(\"$plumb\" ");
        add(&line(join));
        add(b")\npicture=");
        add(&quoted(&joined));
        add(b"\nfolder=");
        add(&quoted(folder.as_os_str()));
        add(b"\n");
        add(SUBMIT_PARTS
            .replace("REMOVE", if *remove { " --remove" } else { "" })
            .as_bytes());
        text
    }

    fn frames(&self, output: &Path) -> Vec<u8> {
        let mut text = Vec::new();
        let mut add = |more: &[u8]| text.extend(more);
        let mut option = OsString::from("--output=");
        option.push(output);
        add(TASK.as_bytes());
        add(RENDER_FRAMES.as_bytes());
        add(&quoted(&option));
        add(b" ");
        add(&self.render_options());
        add(b" || code=$?\n    fi\n");
        add(self.again().as_bytes());
        add(SUBMIT_FRAMES.as_bytes());
        text
    }
}

/// The scenes and their pictures.
fn lists(pictures: &[(PathBuf, PathBuf)], tasks: u32) -> Vec<u8> {
    let mut text = b"scenes=(\n".to_vec();
    let mut add = |path: &PathBuf| {
        text.extend(quoted(path.as_os_str()));
        text.push(b'\n');
    };
    pictures.iter().for_each(|(scene, _)| add(scene));
    text.extend(b")\npictures=(\n");
    let mut add = |path: &PathBuf| {
        text.extend(quoted(path.as_os_str()));
        text.push(b'\n');
    };
    pictures.iter().for_each(|(_, picture)| add(picture));
    text.extend(format!(")\ntasks={tasks}\n\n").as_bytes());
    text
}

/// Submits parts, and the join behind them.
const SUBMIT_PARTS: &str = r#"
set -eu
if [ "${1-}" = missing ]; then
    # Where the parts were removed the picture is whole.
    if [ -e "$picture" ] && [ ! -e "$folder" ]; then
        echo "nothing is missing: $picture is there"
        exit
    fi
    if parts=$("${join[@]}" --check); then
        parts=
    elif [ -z "$parts" ]; then
        exit 2
    fi
fi
after=()
if [ -n "$parts" ]; then
    job=$(sbatch --parsable --array="$parts$at_once" "$script")
    echo "parts $parts: job ${job%%;*}"
    # Whatever becomes of the parts: the join tells which are missing.
    after=(--dependency="afterany:${job%%;*}")
fi
job=$(sbatch --parsable --job-name=join "${options[@]}" "${after[@]}" --requeue --open-mode=append \
    --wrap="cd $(printf %q "$PWD") && exec $(printf '%q ' "${join[@]}")REMOVE")
echo "the picture: job ${job%%;*}, behind them"
"#;

/// Begins what Slurm runs. A node that does not see the folder must not take all tasks: they go back into the queue.
const TASK: &str = "if [ -n \"${SLURM_ARRAY_TASK_ID-}\" ]; then\n";

/// Renders the frames of a task, all in one run, which opens a device and compiles a shader once.
const RENDER_FRAMES: &str = r#"    mine=()
    for ((i = SLURM_ARRAY_TASK_ID - 1; i < ${#scenes[@]}; i += tasks)); do
        if [ "${1-}" != missing ] || [ ! -e "${pictures[i]}" ]; then
            mine+=("${scenes[i]}")
        fi
    done
    if [ "$code" = 0 ] && [ "${#mine[@]}" -gt 0 ]; then
        "$plumb" render "${mine[@]}" "#;

/// Submits frames.
const SUBMIT_FRAMES: &str = r#"
set -eu
array=1-$tasks
if [ "${1-}" = missing ]; then
    declare -A wanted=()
    for i in "${!pictures[@]}"; do
        if [ ! -e "${pictures[i]}" ]; then
            wanted[$((i % tasks + 1))]=1
            echo "missing: ${pictures[i]}"
        fi
    done
    if [ "${#wanted[@]}" = 0 ]; then
        echo "no picture is missing"
        exit
    fi
    array=$(printf '%s\n' "${!wanted[@]}" | sort -n | paste -sd,)
fi
# The tasks take the word as well: what is exported here does not always reach them (sbatch --export=NONE).
job=$(sbatch --parsable --array="$array$at_once" "$script" "$@")
echo "tasks $array: job ${job%%;*}"
"#;
