//! Buffer views within buffers, accessors within views (glTF 2.0, section 3.6).
//!
//! The last byte of an accessor is `offset + stride · (count − 1) + size`. Offsets are multiples of the component's size,
//! strides multiples of 4 from 4 to 252.

use serde_json::Value;

use super::super::fault::Cause;
use super::{Check, whole};

/// What a buffer view holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Vertex attributes.
    Vertices,
    /// Indices of vertices.
    Indices,
    /// An image, keys of an animation, matrices of a skin, or the entries of a sparse accessor.
    Other(&'static str),
}

/// Bytes of a component.
pub fn component_size(code: usize) -> usize {
    match code {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    }
}

/// Bytes from an element to the next where they are dense, and bytes of the last one. Columns of matrices begin at
/// multiples of 4 (section 3.6.2.4); the last column is not padded.
fn element_sizes(kind: &str, component: usize) -> [usize; 2] {
    let matrix = |rows: usize| {
        let column = (rows * component).next_multiple_of(4);
        [rows * column, (rows - 1) * column + rows * component]
    };
    match kind {
        "VEC2" => [2 * component; 2],
        "VEC3" => [3 * component; 2],
        "VEC4" => [4 * component; 2],
        "MAT2" => matrix(2),
        "MAT3" => matrix(3),
        "MAT4" => matrix(4),
        _ => [component; 2],
    }
}

impl<'a> Check<'a> {
    pub(super) fn buffers(&mut self) {
        self.views();
        for (index, accessor) in self.list("accessors").iter().enumerate() {
            self.accessor(accessor, &format!("accessors[{index}]"));
        }
    }

    fn views(&mut self) {
        let (views, buffers) = (self.list("bufferViews"), self.list("buffers"));
        self.uses = vec![None; views.len()];
        for (index, view) in views.iter().enumerate() {
            let (offset, length) = (whole(view, "byteOffset").unwrap_or(0), whole(view, "byteLength").unwrap_or(0));
            let buffer = whole(view, "buffer").unwrap_or(0);
            let holds = buffers.get(buffer).and_then(|buffer| whole(buffer, "byteLength")).unwrap_or(0);
            if offset.checked_add(length).is_none_or(|end| end > holds) {
                let what = format_args!("is {length} from byte {offset} on, beyond the {holds} of buffers[{buffer}]");
                self.faults.add(Cause::Outside, format_args!("bufferViews[{index}].byteLength"), what);
            }
            let Some(stride) = whole(view, "byteStride") else { continue };
            let place = format!("bufferViews[{index}].byteStride");
            if !stride.is_multiple_of(4) {
                self.faults.add(Cause::Misaligned, &place, format_args!("is {stride}; it must be a multiple of 4"));
            } else if !(4..=252).contains(&stride) {
                self.faults.add(Cause::Range, &place, format_args!("is {stride}; it must be from 4 to 252"));
            }
            if stride > length {
                self.warn(&place, format_args!("is {stride}, more than the view's byteLength of {length}"));
            }
            if whole(view, "target") == Some(34963) {
                self.warn(&place, "is for vertex attributes, and the view's target is indices");
            }
        }
    }

    fn accessor(&mut self, accessor: &Value, place: &str) {
        let code = whole(accessor, "componentType").unwrap_or(0);
        let (component, count) = (component_size(code), whole(accessor, "count").unwrap_or(0));
        let kind = accessor["type"].as_str().unwrap_or_default();
        let [dense, size] = element_sizes(kind, component);
        let offset = whole(accessor, "byteOffset");
        if accessor["normalized"] == true && (code == 5126 || code == 5125) {
            self.warn(format_args!("{place}.normalized"), "is for bytes and shorts; it is ignored");
        }
        match whole(accessor, "bufferView") {
            Some(view) => {
                let stride = whole(&self.list("bufferViews")[view], "byteStride").unwrap_or(dense);
                if stride < size {
                    let what =
                        format_args!("its elements have {size} bytes, but bufferViews[{view}].byteStride is {stride}");
                    self.faults.add(Cause::Outside, place, what);
                }
                self.fits(place, "", view, offset.unwrap_or(0), [stride, size, count, component]);
                if let Some(offset) = offset.filter(|offset| kind.starts_with("MAT") && !offset.is_multiple_of(4)) {
                    let what = format_args!("is {offset}; columns of matrices begin at multiples of 4 bytes");
                    self.faults.add(Cause::Misaligned, format_args!("{place}.byteOffset"), what);
                }
            }
            None if offset.is_some() => {
                self.warn(format_args!("{place}.byteOffset"), "has no bufferView; it is ignored")
            }
            None => {}
        }
        let sparse = &accessor["sparse"];
        let Some(replaced) = whole(sparse, "count") else { return };
        if replaced > count {
            let what = format_args!("is {replaced}, more than the accessor's count of {count}");
            self.faults.add(Cause::Count, format_args!("{place}.sparse.count"), what);
        }
        let index_size = component_size(whole(&sparse["indices"], "componentType").unwrap_or(0));
        for (key, dense, size, unit) in
            [("indices", index_size, index_size, index_size), ("values", dense, size, component)]
        {
            let part = &sparse[key];
            let (Some(view), offset) = (whole(part, "bufferView"), whole(part, "byteOffset").unwrap_or(0)) else {
                continue;
            };
            self.fits(place, &format!(".sparse.{key}"), view, offset, [dense, size, replaced, unit]);
            self.used(view, Use::Other("entries of a sparse accessor"), &format!("{place}.sparse.{key}"));
        }
    }

    /// Does the data lie within its view, at a multiple of `unit` bytes?
    fn fits(&mut self, place: &str, part: &str, view: usize, offset: usize, [stride, size, count, unit]: [usize; 4]) {
        let found = &self.list("bufferViews")[view];
        let (start, length) = (whole(found, "byteOffset").unwrap_or(0), whole(found, "byteLength").unwrap_or(0));
        if !offset.is_multiple_of(unit) || !start.saturating_add(offset).is_multiple_of(unit) {
            let at = start.saturating_add(offset);
            let what = format_args!("is {offset}, at byte {at} of the buffer; it must be at a multiple of {unit}");
            self.faults.add(Cause::Misaligned, format_args!("{place}{part}.byteOffset"), what);
        }
        let end = count.saturating_sub(1).checked_mul(stride).and_then(|x| x.checked_add(size)?.checked_add(offset));
        if end.is_none_or(|end| end > length) {
            let ends = end.map_or_else(|| "beyond any memory".to_owned(), |end| format!("at byte {end}"));
            let what = format_args!(
                "names bufferViews[{view}] of {length} bytes, and the data of {count} elements ends {ends}"
            );
            self.faults.add(Cause::Outside, format_args!("{place}{part}.bufferView"), what);
        }
    }

    /// Notes what a view is used for; views have one use, and a stride for vertices alone.
    pub(super) fn used(&mut self, view: usize, what: Use, place: &str) {
        let found = &self.list("bufferViews")[view];
        let before = self.uses[view].replace(what);
        if before.is_some_and(|before| before != what) {
            self.warn(place, format_args!("reads bufferViews[{view}], which is used for other data too"));
        }
        let expected = match what {
            Use::Vertices => Some(34962),
            Use::Indices => Some(34963),
            Use::Other(_) => None,
        };
        if whole(found, "target").is_some_and(|target| Some(target) != expected) {
            self.warn(place, format_args!("reads bufferViews[{view}], whose target is another"));
        }
        if what != Use::Vertices && found.get("byteStride").is_some() {
            self.warn(place, format_args!("reads bufferViews[{view}], whose byteStride is for vertex attributes"));
        }
    }

    /// The same for the view of an accessor, if it has one.
    pub(super) fn accessor_used(&mut self, accessor: usize, what: Use, place: &str) {
        if let Some(view) = whole(&self.list("accessors")[accessor], "bufferView") {
            self.used(view, what, place);
        }
    }

    /// Type and component of an accessor, such as ("VEC3", 5126).
    pub(super) fn format(&self, accessor: usize) -> (&'a str, usize) {
        let found = &self.list("accessors")[accessor];
        (found["type"].as_str().unwrap_or_default(), whole(found, "componentType").unwrap_or(0))
    }

    /// Number of elements of an accessor.
    pub(super) fn count(&self, accessor: usize) -> usize {
        whole(&self.list("accessors")[accessor], "count").unwrap_or(0)
    }
}

/// Name of a component type.
pub fn component_name(code: usize) -> &'static str {
    match code {
        5120 => "BYTE",
        5121 => "UNSIGNED_BYTE",
        5122 => "SHORT",
        5123 => "UNSIGNED_SHORT",
        5125 => "UNSIGNED_INT",
        _ => "FLOAT",
    }
}
