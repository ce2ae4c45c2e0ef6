// The scene as the sun sees it.

@vertex
fn shadow_corner(corner: Corner) -> @builtin(position) vec4f {
    let position = vec4f(before_camera(corner), 1.0);
    let across = dot(view.shadow[0], position);
    let down = dot(view.shadow[1], position);
    return vec4f(2.0 * across - 1.0, 1.0 - 2.0 * down, dot(view.shadow[2], position), 1.0);
}
