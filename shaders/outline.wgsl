// Coverage of a pixel by the inside of a silhouette, in closed form.
//
// By Green's theorem the area of a closed polygon within a box is a sum over its edges: each adds (or, running back,
// subtracts) the area to its right within the box. With the pixel as the box 0 … 1, an edge clipped to its rows runs
// from (xa, ya) to (xb, yb). The area to its right is (yb − ya) (1 − m), where m is the mean of x clamped to 0 … 1:
// with G(x) = ∫ clamp(x, 0, 1) dx, m = (G(xb) − G(xa)) / (xb − xa).

// For each plate a texel (first edge, number of edges), then edges as both ends in pixels.
@group(1) @binding(8) var contours: texture_2d<f32>;

const CONTOUR_ROW: u32 = 256u;
// Pixels with more coverage are drawn by the mesh; ribbons draw slightly more, so that rounding leaves none out.
const WHOLE: f32 = 0.999;
const WHOLE_OF_RIBBON: f32 = 0.9995;

struct Cover {
    // Coverage of the pixel; 1 for a plate without a silhouette.
    part: f32,
    // The edge nearest to the pixel's centre.
    nearest: u32,
}

fn contour(i: u32) -> vec4f {
    return textureLoad(contours, vec2u(i % CONTOUR_ROW, i / CONTOUR_ROW), 0);
}

fn integral_of_clamp(x: f32) -> f32 {
    let c = clamp(x, 0.0, 1.0);
    return 0.5 * c * c + max(x - 1.0, 0.0);
}

// Signed area to the right of the edge from a to b within the box 0 … 1.
fn right_of(a: vec2f, b: vec2f) -> f32 {
    let ya = clamp(a.y, 0.0, 1.0);
    let yb = clamp(b.y, 0.0, 1.0);
    let rise = b.y - a.y;
    let slope = (b.x - a.x) / select(rise, 1.0, abs(rise) < 1e-9);
    let xa = a.x + slope * (ya - a.y);
    let xb = a.x + slope * (yb - a.y);
    let span = xb - xa;
    let middle = clamp(0.5 * (xa + xb), 0.0, 1.0);
    let mean = select((integral_of_clamp(xb) - integral_of_clamp(xa)) / span, middle, abs(span) < 1e-3);
    return (yb - ya) * (1.0 - select(mean, middle, min(xa, xb) >= 1.0 || max(xa, xb) <= 0.0));
}

fn distance_squared(a: vec2f, b: vec2f) -> f32 {
    let along = b - a;
    let t = clamp(-dot(a, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    let foot = a + t * along;
    return dot(foot, foot);
}

// `middle`: centre of the pixel.
fn cover(middle: vec2f, plate: u32) -> Cover {
    let head = contour(plate);
    let first = u32(head.x);
    let count = u32(head.y);
    var area = 0.0;
    var nearest = 0u;
    var least = 1e30;
    for (var i = 0u; i < count; i++) {
        let edge = contour(first + i) - middle.xyxy;
        area += right_of(edge.xy + 0.5, edge.zw + 0.5);
        let far = distance_squared(edge.xy, edge.zw);
        nearest = select(nearest, i, far < least);
        least = min(least, far);
    }
    return Cover(select(min(abs(area), 1.0), 1.0, count == 0u), nearest);
}
