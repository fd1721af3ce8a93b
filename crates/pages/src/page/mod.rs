//! The interactive part of the report: what Rust hands to the program in `assets/report.js`.
//!
//! [`schema`] is the head, JSON that names plots, fields and instants; [`block`] the arrays that the head refers to, compressed and as
//! text. Both are elements of the page, so that it stays one file that asks for nothing. The program is built from `report/` in the root of the
//! repository. A page whose program does not run keeps its tables and its static figures.

pub mod block;
pub mod draft;
pub mod schema;

use crate::Error;
use block::Block;
use schema::Page;

/// The program of the page.
pub const PROGRAM: &str = include_str!("../../assets/report.js");

/// The style of what the program draws.
pub const STYLE: &str = include_str!("../../assets/report.css");

/// The head of a page and its arrays.
#[derive(Debug)]
pub struct Data {
    /// The head.
    pub page: Page,
    /// The arrays that it refers to.
    pub block: Block,
}

impl Data {
    /// The head as JSON that may stand inside of an HTML element, and the arrays as text.
    ///
    /// # Errors
    /// [`Error::Json`].
    pub fn texts(&self) -> Result<[String; 2], Error> {
        // "</script" would end the element
        let head = serde_json::to_string(&self.page)?.replace('<', "\\u003c");
        Ok([head, self.block.text()?])
    }
}
