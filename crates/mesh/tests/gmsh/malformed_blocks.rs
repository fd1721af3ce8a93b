//! Wrong blocks of version 4.1, each with its message.

use super::malformed::{V41, edited};

#[test]
fn blocks_of_version_4_are_checked() {
    edited(
        V41,
        "1 1 0 2\n2",
        "1 1 0 3\n2",
        "line 19: found a block of 3, expected at most 2, which is what the head of the section leaves (node block 2 of 2)",
    );
    edited(
        V41,
        "2 3 1 3",
        "2 4 1 4",
        "line 23: found a total of 3 nodes in the blocks, expected 4, as the head of the section says",
    );
    edited(
        V41,
        "2 3 1 3",
        "3 3 1 3",
        "line 24: found \"$EndNodes\", expected the dimension of an entity, 0 to 3 (node block 3 of 3)",
    );
    edited(
        V41,
        "2 3 1 3",
        "2 -3 1 3",
        "line 15: found \"-3\", expected the number of nodes",
    );
    edited(
        V41,
        "2 3 1 3",
        "2 99 1 3",
        "line 15: found the count 99, expected at most 28, which is what the rest of the file can hold",
    );
    edited(
        V41,
        "1 1 0 2\n2",
        "4 1 0 2\n2",
        "line 19: found 4, expected the dimension of an entity, 0 to 3 (node block 2 of 2)",
    );
    edited(
        V41,
        "1 1 0 2\n2",
        "1 1 5 2\n2",
        "line 19: found 5, expected 0 or 1: whether the nodes have parameters (node block 2 of 2)",
    );
    edited(
        V41,
        "1 1 0 2\n2",
        "1 1 1 2\n2",
        "line 22: found the end of the line, expected a parameter of a node (node block 2 of 2)",
    );
    edited(
        V41,
        "3\n1 0 0",
        "2\n1 0 0",
        "line 21: found a second node with the tag 2, expected a tag not used before",
    );
    edited(
        V41,
        "1 0 0\n0.5",
        "1 inf 0\n0.5",
        "line 22: found inf, expected a finite coordinate (node block 2 of 2)",
    );
    edited(
        V41,
        "1 1 1 2\n1 1 3",
        "1 1 2 2\n1 1 3",
        "line 27: found element type tri3, expected a type of dimension 1, that of the entity (element block 1 of 1)",
    );
    edited(
        V41,
        "1 1 1 2\n1 1 3",
        "1 8 1 2\n1 1 3",
        "line 27: found entity 8 of dimension 1, expected an entity listed before, in $Entities (element block 1 of 1)",
    );
    edited(
        V41,
        "1 1 1 2\n1 1 3",
        "1 1 1 1\n1 1 3",
        "line 28: found a total of 1 elements in the blocks, expected 2, as the head of the section says",
    );
    edited(
        V41,
        "1 1 3\n2",
        "1 1 4\n2",
        "line 28: found node tag 4, expected the tag of a node defined before, in $Nodes (element block 1 of 1)",
    );
    edited(
        V41,
        "2 1 0 0\n1",
        "2 1 0 9999\n1",
        "line 9: found the count 9999, expected at most 18, which is what the rest of the file can hold",
    );
    edited(
        V41,
        "1 0 0 1 1 2",
        "1 0 0 99 1 2",
        "line 12: found the count 99, expected at most 71, which is what the rest of the file can hold (curve 1 of 1)",
    );
    edited(
        V41,
        "2 1 0 0 0",
        "2 1 0 0",
        "line 11: found the end of the line, expected the number of physical groups of an entity (point 2 of 2)",
    );
}
