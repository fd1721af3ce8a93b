//! `[material]`: density and law.

use std::borrow::Cow;

use carom_materials::Law;
use carom_quantities::Density;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value};

/// Key that stands beside the law, and that the law's own parameters include.
const DENSITY: &str = "density";

/// A material: one law. In the file its density stands beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material(pub Law);

impl<'de> Deserialize<'de> for Material {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Material, D::Error> {
        let mut table = Map::deserialize(deserializer)?;
        if let Some(density) = table.remove(DENSITY) {
            for law in table.values_mut().filter_map(Value::as_object_mut) {
                law.insert(DENSITY.to_owned(), density.clone());
            }
        }
        let law = Law::deserialize(Value::Object(table)).map_err(D::Error::custom)?;
        Ok(Material(law))
    }
}

impl Serialize for Material {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut table = serde_json::to_value(self.0).map_err(serde::ser::Error::custom)?;
        if let Some(Value::Object(law)) = table.get_mut(self.0.key()) {
            law.remove(DENSITY);
        }
        table[DENSITY] = self.0.density().into();
        table.serialize(serializer)
    }
}

/// The choice of a law, its keys beside that of the density.
impl JsonSchema for Material {
    fn schema_name() -> Cow<'static, str> {
        "Material".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let choice = Law::json_schema(generator);
        let mut density = generator.subschema_for::<Density>();
        density.insert("description".to_owned(), "Mass density.".into());
        let mut properties = Map::from_iter([(DENSITY.to_owned(), density.into())]);
        let mut keys = Vec::new();
        let branches = choice.get("oneOf").and_then(Value::as_array);
        for branch in branches.into_iter().flatten() {
            let laws = branch["properties"].as_object().into_iter().flatten();
            for (key, law) in laws {
                let mut law = law.clone();
                law["description"] = branch["description"].clone();
                properties.insert(key.clone(), law);
                keys.push(json_schema!({ "required": [key] }));
            }
        }
        json_schema!({
            "description": "A material: one law. Only `elastic` is for small strain; the others are for large displacements, rotations and strains, in plane strain, axisymmetric and solid bodies.",
            "type": "object",
            "properties": properties,
            "required": [DENSITY],
            "oneOf": keys,
            "additionalProperties": false,
        })
    }
}
