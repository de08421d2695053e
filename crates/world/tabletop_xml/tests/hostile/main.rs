//! Faulty files of every kind: each gives faults, never a panic or a hang, and the table always exists.

mod faults;
mod random;
mod scenes;

use std::path::Path;

use tabletop_xml::{ParsedTask, parse};

const SAMPLE: &str = r##"<?xml version="1.0" encoding="UTF-8"?>
<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml"
  xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
  xsi:schemaLocation="http://synapse.cs.umd.edu/tabletop-xml tabletop.xsd " xspan="20" yspan="12">
  <!-- é -->
  <block id="a" location="(-2,0,1)" rotation="(0,0,45)" color="green" xspan="2"/>
  <sphere location="(0,0,2)" radius=".5" mass="1e-1"><description name="n" value="&lt;x&gt;"/></sphere>
  <composite location="(0,0,1)" mass="10"><composite id="head" location="(-0.2,0,0)">
    <cylinder color="#00A57F" radius="0.75" yspan="0.8" location="(0,0.9,0)"/></composite></composite>
  <box location="(0,5,1.5)" zspan="3" thickness="0.2"/>
  <chain color="magenta" start="(6,-2,4)" end="(-6,-2,4)" linkCount="12"/>
  <lidbox xspan="6" yspan="5" zspan="5" thickness="0.6" location="(0,0,2.5)" mass="10" handleXspan="1"/>
</tabletop>
"##;

fn read(text: impl AsRef<[u8]>) -> ParsedTask {
    parse(Path::new("f.xml"), text.as_ref())
}

fn lines(text: impl AsRef<[u8]>) -> Vec<String> {
    read(text).faults.iter().map(ToString::to_string).collect()
}
