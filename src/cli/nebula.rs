//! `scotopic nebula`: reflection nebulae, dust lit by stars.

use clap::{Args, Subcommand};

use super::Failure;

/// What was computed before.
pub mod cache;
/// Linear light in a file becomes a picture.
pub mod develop;
/// How light becomes a picture for people.
pub mod developing;
/// Where the eye stands.
pub mod eye;
/// Volumes in files.
pub mod files;
/// Frames along a camera path.
pub mod fly;
/// The thesis' figures, made again.
pub mod gallery;
/// A nebula out of nothing.
pub mod generate;
/// How light is scattered and given off.
pub mod lighting;
/// Pictures in files.
pub mod out;
/// Photons through a sphere of dust.
pub mod photons;
/// The accurate picture.
pub mod render;
/// What is lit and by what.
pub mod scene;
/// What a volume holds.
pub mod show;
/// The scattering table.
pub mod table;
/// Numbers of three axes on the command line.
pub mod triple;
/// A flight in the terminal.
pub mod view;

/// What is asked of a nebula.
#[derive(Debug, Clone, Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Clone, Subcommand)]
enum Command {
    /// Make a picture of linear light, before a photograph or a field of stars
    Develop(develop::Arguments),
    /// Make frames along a camera path; any number of machines share them out
    Fly(Box<fly::Arguments>),
    /// Make the thesis' pictures of nebulae again, each with its command lines
    Gallery(gallery::Arguments),
    /// Make a volume of dust: noise in a shape, swept clean around the stars
    Generate(Box<generate::Arguments>),
    /// Follow photons through a sphere of even dust
    Photons(photons::Arguments),
    /// Make a picture: as right as is asked, and it says how right it is
    Render(Box<render::Arguments>),
    /// Say what a volume holds; slices and columns as pictures
    Show(show::Arguments),
    /// Make the scattering table of the thesis: light out of a voxel, by depth and angle
    Table(Box<table::Arguments>),
    /// Fly through a volume in the terminal, in red
    View(Box<view::Arguments>),
}

/// Answers it.
///
/// # Errors
/// A sentence that says what is wrong and what to do.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    execute(&arguments.command)
}

/// Answers one command.
fn execute(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Develop(arguments) => develop::run(arguments),
        Command::Fly(arguments) => fly::run(arguments),
        Command::Gallery(arguments) => gallery::run(arguments),
        Command::Generate(arguments) => generate::run(arguments),
        Command::Photons(arguments) => photons::run(arguments),
        Command::Render(arguments) => render::run(arguments),
        Command::Show(arguments) => show::run(arguments),
        Command::Table(arguments) => table::run(arguments),
        Command::View(arguments) => view::run(arguments),
    }
}
