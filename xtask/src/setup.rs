//! Brings a new machine to the point where the workspace builds.

use std::{
    env,
    io::{self, IsTerminal, Write},
    process::Command,
};

use anyhow::{Context, Result, bail};
use clap::Args;

use crate::{openblas, process};

/// Check for what the build needs and install what is missing
///
/// Needs a C compiler, OpenBLAS as a static library and the Fortran run-time library. Installs with
/// apt-get, dnf or brew: as root, or through sudo after asking. Installs nothing and takes no
/// time when everything is there.
#[derive(Args)]
pub struct Options {
    /// Only say what is there and what is missing; fail if anything is
    #[arg(long)]
    check: bool,
    /// Install without asking
    #[arg(short, long)]
    yes: bool,
}

/// Something the build needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Need {
    Compiler,
    OpenBlas,
    Fortran,
    Rustfmt,
    Clippy,
}

impl Need {
    const ALL: [Self; 5] =
        [Self::Compiler, Self::OpenBlas, Self::Fortran, Self::Rustfmt, Self::Clippy];

    fn name(self) -> &'static str {
        match self {
            Self::Compiler => "a C compiler",
            Self::OpenBlas => "libopenblas.a",
            Self::Fortran => "libgfortran.a",
            Self::Rustfmt => "cargo fmt",
            Self::Clippy => "cargo clippy",
        }
    }

    /// Where it was found.
    fn find(self) -> Option<String> {
        match self {
            Self::Compiler => {
                let chosen = env::var("CC").unwrap_or_else(|_| "cc".into());
                process::succeeds(&chosen, &["--version"]).then_some(chosen)
            }
            Self::OpenBlas => {
                let archive = openblas::archive_dir(env::consts::ARCH)?.join("libopenblas.a");
                let threaded = openblas::is_threaded(&archive).unwrap_or(false);
                let note = if threaded { " (threaded: see crates/openblas-src)" } else { "" };
                Some(format!("{}{note}", archive.display()))
            }
            Self::Fortran => openblas::runtime_dir("gfortran").map(|dir| dir.display().to_string()),
            Self::Rustfmt => {
                process::succeeds("cargo", &["fmt", "--version"]).then(|| "here".into())
            }
            Self::Clippy => {
                process::succeeds("cargo", &["clippy", "--version"]).then(|| "here".into())
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Manager {
    Apt,
    Dnf,
    Brew,
}

impl Manager {
    fn detect() -> Option<Self> {
        [(Self::Apt, "apt-get"), (Self::Dnf, "dnf"), (Self::Brew, "brew")].into_iter().find_map(
            |(manager, program)| process::succeeds(program, &["--version"]).then_some(manager),
        )
    }

    fn packages(self, need: Need) -> &'static [&'static str] {
        match (self, need) {
            (_, Need::Rustfmt | Need::Clippy) => &[],
            (Self::Apt, Need::Compiler) => &["gcc", "libc6-dev"],
            // The serial build, on Debian since 10 and on Ubuntu since 20.04.
            (Self::Apt, Need::OpenBlas) => &["libopenblas-serial-dev"],
            (Self::Apt, Need::Fortran) => &["gfortran"],
            (Self::Dnf, Need::Compiler) | (Self::Brew, Need::Compiler | Need::Fortran) => &["gcc"],
            (Self::Dnf, Need::OpenBlas) => &["openblas-static"],
            (Self::Dnf, Need::Fortran) => {
                &["gcc-gfortran", "libgfortran-static", "libquadmath-static"]
            }
            (Self::Brew, Need::OpenBlas) => &["openblas"],
        }
    }

    /// The commands that install what is missing, without the `sudo` they may need.
    fn commands(self, missing: &[Need]) -> Vec<Vec<&'static str>> {
        let mut packages: Vec<_> =
            missing.iter().flat_map(|need| self.packages(*need)).copied().collect();
        packages.dedup();
        if packages.is_empty() {
            return Vec::new();
        }
        let quiet = ["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"];
        let mut steps = match self {
            Self::Apt => vec![
                [&quiet[..], &["update"]].concat(),
                [&quiet[..], &["install", "-y", "--no-install-recommends"]].concat(),
            ],
            Self::Dnf => vec![vec!["dnf", "install", "-y"]],
            Self::Brew => vec![vec!["brew", "install"]],
        };
        if let Some(install) = steps.last_mut() {
            install.extend(packages);
        }
        steps
    }

    fn needs_root(self) -> bool {
        self != Self::Brew
    }
}

/// The task as its options ask for it.
pub fn run(options: &Options) -> Result<()> {
    if !options.check {
        return ensure(options.yes);
    }
    let missing = missing();
    if missing.is_empty() {
        return Ok(());
    }
    bail!("missing: {}. Run `cargo xtask setup`", names(&missing))
}

/// Installs what is missing; `yes` answers the question that comes before it.
///
/// # Errors
///
/// Nobody agreed, no known package manager is here, or something is still missing afterwards.
pub fn ensure(yes: bool) -> Result<()> {
    let missing_before = missing();
    if missing_before.is_empty() {
        return Ok(());
    }
    let steps = steps(&missing_before)?;
    agree(&steps, yes)?;
    for step in &steps {
        process::run(Command::new(&step[0]).args(&step[1..]))?;
    }
    let still = missing();
    if !still.is_empty() {
        bail!("still missing after installing: {}. README.md names the packages", names(&still));
    }
    Ok(())
}

/// Looks for every need, prints what it finds and returns what it does not.
fn missing() -> Vec<Need> {
    let is_missing = |need: &Need| {
        let place = need.find();
        println!("setup: {:<13} {}", need.name(), place.as_deref().unwrap_or("missing"));
        place.is_none()
    };
    Need::ALL.into_iter().filter(is_missing).collect()
}

fn names(needs: &[Need]) -> String {
    needs.iter().map(|need| need.name()).collect::<Vec<_>>().join(", ")
}

fn steps(missing: &[Need]) -> Result<Vec<Vec<String>>> {
    let (rust, system): (Vec<_>, Vec<_>) =
        missing.iter().partition(|need| matches!(need, Need::Rustfmt | Need::Clippy));
    let mut steps = Vec::new();
    if !system.is_empty() {
        let manager = Manager::detect().with_context(|| {
            format!(
                "missing: {}; found none of apt-get, dnf and brew to install it. Install it \
                 yourself; for an OpenBLAS in an unusual place set OPENBLAS_LIB_DIR",
                names(&system)
            )
        })?;
        let sudo = manager.needs_root() && !is_root();
        for step in manager.commands(&system) {
            let prefix = sudo.then_some("sudo");
            steps.push(prefix.into_iter().chain(step).map(str::to_owned).collect());
        }
    }
    if !rust.is_empty() {
        let words = ["rustup", "component", "add", "rustfmt", "clippy"];
        steps.push(words.map(str::to_owned).to_vec());
    }
    Ok(steps)
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|out| out.stdout.trim_ascii() == b"0")
}

/// Root, an explicit yes and a build server (which sets `CI`) need no question.
fn agree(steps: &[Vec<String>], yes: bool) -> Result<()> {
    let commands: Vec<_> = steps.iter().map(|step| format!("  {}", step.join(" "))).collect();
    let commands = commands.join("\n");
    println!("setup: to install what is missing:\n{commands}");
    if yes || is_root() || env::var_os("CI").is_some_and(|value| !value.is_empty()) {
        return Ok(());
    }
    if !io::stdin().is_terminal() {
        bail!("nobody here to ask: run the commands above, or `cargo xtask setup --yes`");
    }
    print!("Run them now? [y/N] ");
    io::stdout().flush()?;
    let mut answer = String::new();
    io::stdin().read_line(&mut answer)?;
    if !matches!(answer.trim().to_lowercase().as_str(), "y" | "yes") {
        bail!("nothing installed: run the commands above when you are ready");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apt_updates_its_lists_then_installs_only_what_is_missing() {
        let steps = Manager::Apt.commands(&[Need::OpenBlas, Need::Fortran]);
        assert_eq!(steps[0].join(" "), "env DEBIAN_FRONTEND=noninteractive apt-get update");
        let install = steps[1].join(" ");
        assert!(install.ends_with("--no-install-recommends libopenblas-serial-dev gfortran"));
        assert!(!install.contains("gcc"));
    }

    #[test]
    fn brew_installs_the_compiler_once_though_two_needs_ask_for_it() {
        let steps = Manager::Brew.commands(&[Need::Compiler, Need::Fortran]);
        assert_eq!(steps, [["brew", "install", "gcc"]]);
    }

    #[test]
    fn the_system_manager_is_left_alone_when_only_rust_parts_are_missing() {
        assert!(Manager::Apt.commands(&[Need::Clippy]).is_empty());
        let steps = steps(&[Need::Clippy]).expect("needs no package manager");
        assert_eq!(steps, [["rustup", "component", "add", "rustfmt", "clippy"]]);
    }
}
