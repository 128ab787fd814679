# Largest rotation (degrees) and displacement (mm) of each body of a trace between two times, relative to its pose at the first:
#   awk -F, -v from=3 -v to=9 -f turn.awk trace.csv
# q = conj(a) b is the rotation from pose a to pose b; its angle is 2 atan2(|vector part|, |scalar part|), exact near 0.
NR == 1 || $1 < from || $1 > to { next }
!($2 in w) { x[$2] = $3; y[$2] = $4; z[$2] = $5; w[$2] = $6; i[$2] = $7; j[$2] = $8; k[$2] = $9; turn[$2] = shift[$2] = 0 }
{
    a = w[$2]; b = i[$2]; c = j[$2]; d = k[$2]
    s = a * $6 + b * $7 + c * $8 + d * $9
    u = a * $7 - b * $6 - c * $9 + d * $8
    v = a * $8 - c * $6 - d * $7 + b * $9
    t = a * $9 - d * $6 - b * $8 + c * $7
    angle = 2 * atan2(sqrt(u * u + v * v + t * t), s < 0 ? -s : s) * 45 / atan2(1, 1)
    far = 1000 * sqrt(($3 - x[$2]) ^ 2 + ($4 - y[$2]) ^ 2 + ($5 - z[$2]) ^ 2)
    if (angle > turn[$2]) turn[$2] = angle
    if (far > shift[$2]) shift[$2] = far
}
END { for (body in turn) printf "%s %.4f %.4f\n", body, turn[body], shift[body] }
