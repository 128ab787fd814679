//! Channels and samplers of animations (glTF 2.0, section 3.11 and appendix C).

use std::collections::BTreeMap;

use serde_json::Value;

use super::super::fault::Cause;
use super::buffers::{Use, component_name};
use super::{Check, whole};

const FLOAT: usize = 5126;
const UNSIGNED_INT: usize = 5125;

impl Check<'_> {
    pub(super) fn animations(&mut self) {
        for (index, animation) in self.list("animations").iter().enumerate() {
            let place = format!("animations[{index}]");
            let samplers = animation["samplers"].as_array().map_or(&[][..], Vec::as_slice);
            for (s, sampler) in samplers.iter().enumerate() {
                self.sampler(sampler, &format!("{place}.samplers[{s}]"));
            }
            let mut moved: BTreeMap<(usize, &str), usize> = BTreeMap::new();
            for (c, channel) in animation["channels"].as_array().into_iter().flatten().enumerate() {
                let at = format!("{place}.channels[{c}]");
                let target = &channel["target"];
                let (Some(node), Some(path)) = (whole(target, "node"), target["path"].as_str()) else { continue };
                if let Some(other) = moved.insert((node, path), c) {
                    let what = format_args!("moves the {path} of nodes[{node}], as channels[{other}] does");
                    self.faults.add(Cause::Conflict, format_args!("{at}.target"), what);
                }
                let sampler = whole(channel, "sampler").unwrap_or(0);
                match samplers.get(sampler) {
                    Some(found) => self.channel(found, node, path, &at),
                    None => {
                        let what = format_args!("is {sampler}, but the animation has {} samplers", samplers.len());
                        self.faults.add(Cause::Index, format_args!("{at}.sampler"), what);
                    }
                }
            }
        }
    }

    fn sampler(&mut self, sampler: &Value, place: &str) {
        let Some(input) = whole(sampler, "input") else { return };
        let at = format!("{place}.input");
        let found = &self.list("accessors")[input];
        let (kind, component) = self.format(input);
        if (kind, component) != ("SCALAR", FLOAT) {
            let name = component_name(component);
            let what = format_args!("names accessors[{input}] of {kind} {name}; times are SCALAR of FLOAT");
            self.faults.add(Cause::Format, &at, what);
        }
        if found.get("min").is_none() || found.get("max").is_none() {
            self.warn(&at, format_args!("names accessors[{input}], which has no min and max"));
        }
        if sampler["interpolation"] == "CUBICSPLINE" && self.count(input) < 2 {
            self.warn(&at, "has one key; CUBICSPLINE needs two");
        }
        self.accessor_used(input, Use::Other("keys of an animation"), &at);
        if let Some(output) = whole(sampler, "output") {
            self.accessor_used(output, Use::Other("keys of an animation"), &format!("{place}.output"));
        }
    }

    fn channel(&mut self, sampler: &Value, node: usize, path: &str, at: &str) {
        let (Some(input), Some(output)) = (whole(sampler, "input"), whole(sampler, "output")) else { return };
        let (kind, component) = self.format(output);
        let wanted = match path {
            "rotation" => "VEC4",
            "weights" => "SCALAR",
            _ => "VEC3",
        };
        let whole_numbers = matches!(path, "rotation" | "weights") && component != UNSIGNED_INT;
        if kind != wanted || !(component == FLOAT || whole_numbers) {
            let name = component_name(component);
            let what = format_args!("plays accessors[{output}] of {kind} {name}; a {path} is {wanted} of FLOAT");
            self.faults.add(Cause::Format, format_args!("{at}.sampler"), what);
            return;
        }
        let found = &self.list("nodes")[node];
        if path != "weights" && found.get("matrix").is_some() {
            self.warn(
                format_args!("{at}.target"),
                format_args!("moves nodes[{node}], which has a matrix; it is taken apart"),
            );
        }
        if path == "weights" {
            // Their number depends on the mesh; the decoder counts them.
            return;
        }
        let each = if sampler["interpolation"] == "CUBICSPLINE" { 3 } else { 1 };
        let (keys, values) = (self.count(input), self.count(output));
        if keys.checked_mul(each) != Some(values) {
            let what = format_args!("has {keys} keys of {each} values each, and accessors[{output}] has {values}");
            self.faults.add(Cause::Count, format_args!("{at}.sampler"), what);
        }
    }
}
