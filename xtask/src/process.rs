//! Running other programs and finding the workspace.

use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail};

/// The root of the workspace: cargo tells a program that it runs where its manifest lies.
pub fn workspace_root() -> Result<PathBuf> {
    let manifest_dir = env::var_os("CARGO_MANIFEST_DIR")
        .context("not started by cargo: run this program as `cargo xtask`")?;
    let root = Path::new(&manifest_dir).parent().context("the folder of xtask has no parent")?;
    Ok(root.to_path_buf())
}

/// A call of the cargo that runs this program, at the root of the workspace.
pub fn cargo(root: &Path) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root);
    command
}

/// Builds the workspace's own `mocap` program for speed, with the progress of the build shown.
pub fn build_mocap(root: &Path) -> Result<()> {
    run(cargo(root).args(["build", "--release", "--package", "mocap-cli"]))
}

/// A call of the program that [`build_mocap`] builds.
pub fn mocap(root: &Path) -> Command {
    let mut command = cargo(root);
    command.args(["run", "--quiet", "--release", "--package", "mocap-cli", "--"]);
    command
}

/// Runs a command to its end, its output shown as it comes.
///
/// # Errors
///
/// The program cannot be started, or ends with a code other than zero.
pub fn run(command: &mut Command) -> Result<()> {
    let shown = display(command);
    println!("$ {shown}");
    let status = command.status().with_context(|| format!("cannot start `{shown}`"))?;
    if !status.success() {
        bail!("`{shown}` ended with {status}");
    }
    Ok(())
}

/// Whether a command can be started and ends well; its output is dropped.
pub fn succeeds(program: &str, args: &[&str]) -> bool {
    Command::new(program).args(args).output().is_ok_and(|out| out.status.success())
}

/// A command as one would type it.
pub fn display(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_name().unwrap_or(command.get_program());
    std::iter::once(program)
        .chain(command.get_args())
        .map(|word| word.to_string_lossy())
        .collect::<Vec<_>>()
        .join(" ")
}
