//! Quantities: one type for each dimension and range, so that a field says its unit by its type.
//!
//! In the file each is a number in SI units or a text with a unit (`"254 mm"`). Reading checks the dimension; the range stands in the
//! schema: whoever reads a file checks it.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize};

use crate::units::{Dimension, parse_quantity};

/// A number or a text with a unit, as it stands in the file.
#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    Number(f64),
    Text(String),
}

impl Written {
    /// The SI value. The dimension is one of `units::NAMED`.
    fn si(&self, dimension: &str) -> Result<f64, String> {
        match self {
            Written::Number(value) => Ok(*value),
            Written::Text(text) => {
                let wanted = Dimension::named(dimension)
                    .ok_or_else(|| format!("no dimension is called {dimension}"))?;
                parse_quantity(text, wanted).map_err(|error| error.to_string())
            }
        }
    }
}

macro_rules! quantity {
    ($name:ident, $dimension:literal, $unit:literal, $example:literal, $bound:expr, $doc:literal) => {
        #[doc = $doc]
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
        pub struct $name(pub f64);

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let written = Written::deserialize(deserializer)?;
                written.si($dimension).map($name).map_err(serde::de::Error::custom)
            }
        }

        #[cfg(test)]
        impl tests::Example for $name {
            const EXAMPLE: &'static str = $example;
        }

        impl $name {
            /// Reads the SI value alone: `deserialize_with` of a field of type `f64`.
            ///
            /// # Errors
            /// What is no such quantity.
            pub fn si<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
                Ok($name::deserialize(deserializer)?.0)
            }

            /// The same of a field that may be left out.
            ///
            /// # Errors
            /// What is no such quantity.
            pub fn some_si<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
                Ok(Option::<$name>::deserialize(deserializer)?.map(|quantity| quantity.0))
            }
        }

        impl JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }
            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                let mut schema = json_schema!({
                    "type": ["number", "string"],
                    "x-dimension": $dimension,
                    "x-unit": $unit,
                    "x-example": $example,
                });
                let bound: Option<(&str, f64)> = $bound;
                if let Some((keyword, value)) = bound {
                    schema.insert(keyword.to_owned(), value.into());
                }
                schema
            }
        }
    };
}

const POSITIVE: Option<(&str, f64)> = Some(("exclusiveMinimum", 0.0));
const NOT_NEGATIVE: Option<(&str, f64)> = Some(("minimum", 0.0));

quantity!(
    Coordinate,
    "length",
    "m",
    "254 mm",
    None,
    "A coordinate or a displacement, m."
);
quantity!(
    Length,
    "length",
    "m",
    "254 mm",
    POSITIVE,
    "A length greater than zero, m."
);
quantity!(
    Clearance,
    "length",
    "m",
    "2 mm",
    NOT_NEGATIVE,
    "A length, zero or more, m."
);
quantity!(
    Area,
    "area",
    "m^2",
    "645 mm^2",
    POSITIVE,
    "An area greater than zero, m²."
);
quantity!(
    Energy,
    "energy",
    "J",
    "2 mJ",
    POSITIVE,
    "An energy greater than zero, J."
);
quantity!(
    SecondMoment,
    "second moment of area",
    "m^4",
    "1943 cm^4",
    POSITIVE,
    "A second moment of area greater than zero, m⁴."
);
quantity!(
    Duration,
    "time",
    "s",
    "0.25 us",
    POSITIVE,
    "A time greater than zero, s."
);
quantity!(
    Density,
    "density",
    "kg/m^3",
    "7.8 t/m^3",
    POSITIVE,
    "A mass density greater than zero, kg/m³."
);
quantity!(
    LineMass,
    "mass per length",
    "kg/m",
    "12 kg/m",
    POSITIVE,
    "A mass per length greater than zero, kg/m."
);
quantity!(
    Modulus,
    "stress",
    "Pa",
    "210 GPa",
    POSITIVE,
    "A modulus greater than zero, Pa."
);
quantity!(
    Velocity,
    "velocity",
    "m/s",
    "36 km/h",
    None,
    "A velocity, m/s."
);
quantity!(
    Speed,
    "velocity",
    "m/s",
    "10 m/s",
    POSITIVE,
    "A speed greater than zero, m/s."
);
quantity!(
    Acceleration,
    "acceleration",
    "m/s^2",
    "-9.81 m/s^2",
    None,
    "An acceleration, m/s²."
);
quantity!(
    SurfaceStiffness,
    "stiffness per area",
    "Pa/m",
    "1 GPa/mm",
    POSITIVE,
    "A stiffness per area greater than zero, Pa/m."
);
quantity!(
    SurfaceDamping,
    "damping per area",
    "Pa*s/m",
    "20 MPa*s/m",
    NOT_NEGATIVE,
    "A damping per area, zero or more, Pa s/m."
);

quantity!(
    Force,
    "force",
    "N",
    "10 kN",
    POSITIVE,
    "A force greater than zero, N."
);
quantity!(
    SignedForce,
    "force",
    "N",
    "-10 kN",
    None,
    "A force of any sign, N."
);
quantity!(
    SignedMoment,
    "moment",
    "N*m",
    "-10 kN*m",
    None,
    "A moment of a force, of any sign, N m."
);
quantity!(
    Weight,
    "mass",
    "kg",
    "100 kg",
    POSITIVE,
    "A mass greater than zero, kg."
);
quantity!(
    Stiffness,
    "stiffness",
    "N/m",
    "10 kN/m",
    POSITIVE,
    "A stiffness greater than zero, N/m."
);
quantity!(
    Damping,
    "damping",
    "N*s/m",
    "20 kN*s/m",
    NOT_NEGATIVE,
    "A damping, zero or more, N s/m."
);

quantity!(
    Stress,
    "stress",
    "Pa",
    "100 MPa",
    NOT_NEGATIVE,
    "A stress, zero or more, Pa."
);
quantity!(
    SignedStress,
    "stress",
    "Pa",
    "2 MPa",
    None,
    "A stress of any sign, Pa."
);
quantity!(
    Delay,
    "time",
    "s",
    "1 ms",
    NOT_NEGATIVE,
    "A time, zero or more, s."
);
quantity!(
    Rate,
    "frequency",
    "1/s",
    "10 s^-1",
    NOT_NEGATIVE,
    "A rate, zero or more, 1/s."
);
quantity!(
    Frequency,
    "frequency",
    "Hz",
    "5 Hz",
    POSITIVE,
    "A frequency greater than zero, Hz."
);
quantity!(
    MomentOfInertia,
    "moment of inertia",
    "kg*m^2",
    "2 kg*m^2",
    POSITIVE,
    "A moment of inertia greater than zero, kg m²."
);
quantity!(Angle, "angle", "rad", "30 deg", None, "An angle, rad.");
quantity!(
    AngularVelocity,
    "frequency",
    "rad/s",
    "3 rad/s",
    None,
    "An angular velocity, rad/s."
);

/// One to three components of a vector; those left out are zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Vector<Q>(pub Vec<Q>);

impl<Q: JsonSchema> JsonSchema for Vector<Q> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("Vector{}", Q::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": generator.subschema_for::<Q>(), "minItems": 1, "maxItems": 3 })
    }
}

impl<Q: Copy + Into<f64>> Vector<Q> {
    /// The components in SI units, zeros added.
    pub fn si(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.0.get(axis).map_or(0.0, |&component| component.into()))
    }

    /// How many components the file gives: 1, 2 or 3.
    pub fn given(&self) -> usize {
        self.0.len()
    }
}

macro_rules! into_si {
    ($($name:ident)*) => {
        $(impl From<$name> for f64 {
            fn from(quantity: $name) -> f64 {
                quantity.0
            }
        })*
    };
}

into_si!(Energy SecondMoment Frequency MomentOfInertia Angle SignedForce SignedMoment Weight Stiffness Coordinate Length Area Duration Density Modulus Velocity Speed Acceleration SurfaceStiffness SurfaceDamping Clearance Force Damping Stress SignedStress Delay Rate AngularVelocity);

#[cfg(test)]
mod tests {
    use serde::Deserialize;
    use serde::de::IntoDeserializer;
    use serde::de::value::{Error, StrDeserializer};

    /// The example that the reference shows.
    pub(super) trait Example: for<'de> Deserialize<'de> {
        const EXAMPLE: &'static str;
    }

    fn reads<T: Example>() {
        let text: StrDeserializer<Error> = T::EXAMPLE.into_deserializer();
        if let Err(error) = T::deserialize(text) {
            panic!("{}: {error}", T::EXAMPLE);
        }
    }

    #[test]
    fn every_quantity_reads_its_own_example() {
        reads::<super::Coordinate>();
        reads::<super::Length>();
        reads::<super::Clearance>();
        reads::<super::Area>();
        reads::<super::SecondMoment>();
        reads::<super::Duration>();
        reads::<super::Density>();
        reads::<super::LineMass>();
        reads::<super::Modulus>();
        reads::<super::Velocity>();
        reads::<super::Speed>();
        reads::<super::Acceleration>();
        reads::<super::SurfaceStiffness>();
        reads::<super::SurfaceDamping>();
        reads::<super::Force>();
        reads::<super::SignedForce>();
        reads::<super::SignedMoment>();
        reads::<super::Weight>();
        reads::<super::Stiffness>();
        reads::<super::Damping>();
        reads::<super::Stress>();
        reads::<super::SignedStress>();
        reads::<super::Delay>();
        reads::<super::Rate>();
        reads::<super::Frequency>();
        reads::<super::MomentOfInertia>();
        reads::<super::Angle>();
        reads::<super::Energy>();
        reads::<super::AngularVelocity>();
    }
}
