//! The variables that scripts share with the program (report section 5.2): `sensor`, `motor` and `aux`.

pub(crate) mod auxiliary;
pub(crate) mod invalid_field;
pub(crate) mod matrix;
pub(crate) mod motor;
pub(crate) mod sensor;
