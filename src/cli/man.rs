//! `tabletop man`: the manual page.

use std::{
    io::{self, Write},
    process::ExitCode,
};

use clap::Command;
use clap_mangen::{
    Man,
    roff::{Roff, roman},
};

use super::{Failure, Output};

/// Prints the page of the program.
pub(super) fn man(program: Command) -> Result<ExitCode, Failure> {
    let page = page(program).map_err(Failure::run)?;
    Output::Stdout.write(page.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// The page of a program, with a chapter for each of its commands.
fn page(program: Command) -> io::Result<String> {
    // Built as a whole, so that commands know the name of the program.
    let mut program = program
        .disable_help_subcommand(true)
        .subcommand_value_name("COMMAND");
    program.build();
    let mut page = Vec::new();
    // An empty date would not be quoted, so that the next argument would be taken for it.
    let man = Man::new(program.clone()).date(" ");
    let man = man.manual("User Commands");
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    for command in program.get_subcommands() {
        write_chapter(command, &mut page)?;
    }
    write_end(&program, &mut page)?;
    man.render_version_section(&mut page)?;
    let page = String::from_utf8(page).map_err(io::Error::other)?;
    // Every part has it.
    let preamble = Roff::new().render();
    Ok(preamble.clone() + &page.replace(&preamble, ""))
}

/// Writes the chapter of a command and those of the commands below it.
fn write_chapter(command: &Command, page: &mut Vec<u8>) -> io::Result<()> {
    let name = command.get_bin_name().unwrap_or(command.get_name());
    Roff::new().control("SH", [name]).to_writer(page)?;
    let mut sections = Vec::new();
    let man = Man::new(command.clone());
    man.render_description_section(&mut sections)?;
    man.render_synopsis_section(&mut sections)?;
    man.render_options_section(&mut sections)?;
    let sections = String::from_utf8(sections).map_err(io::Error::other)?;
    let below = sections.replace("\n.SH ", "\n.SS ");
    page.write_all(below.as_bytes())?;
    let mut commands = command.get_subcommands();
    commands.try_for_each(|command| write_chapter(command, page))
}

/// Writes the end of the long help, whose sections are apart by an empty line and have a heading with a colon.
fn write_end(program: &Command, page: &mut Vec<u8>) -> io::Result<()> {
    let end = program.get_after_long_help();
    let end = end.map(ToString::to_string).unwrap_or_default();
    let mut roff = Roff::new();
    for section in end.split("\n\n") {
        let (heading, lines) = section.split_once(":\n").unwrap_or(("NOTES", section));
        roff.control("SH", [heading.to_uppercase().as_str()]);
        for line in lines.lines() {
            roff.text([roman(line)]);
        }
    }
    roff.to_writer(page)
}
