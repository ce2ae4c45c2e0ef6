// What every pass knows: the camera, the light, and how a corner of a mesh comes before the camera.
//
// Everything is in the camera's coordinates, x forward, y to the left, z up: numbers stay small however far from the
// origin of the world the camera is.

// Whether there is fog. That, and the like, is a choice of programs: llvmpipe compiles a program anew for every value of a
// uniform that decides on a branch, and takes as long for a branch that is not taken as for one that is.
override FOG: bool = false;

struct View {
    // The middle of the image in pixels, metres across per pixel at 1 m, the nearest that is drawn.
    image: vec4f,
    // How y / x and z / x become coordinates from -1 to 1.
    project: vec4f,
    // Towards the sun; how much lamps shine.
    sun: vec4f,
    // Up; the extinction of the fog in 1/m.
    up: vec4f,
    sun_light: vec4f,
    sky_light: vec4f,
    ground_light: vec4f,
    // What the fog and the horizon look like.
    air: vec4f,
    zenith: vec4f,
    // Where the head lamps are, and how bright; where they point.
    head_lamps: vec4f,
    head_beam: vec4f,
    // Where street lamps are, and how bright: 0 for none.
    street_lamps: array<vec4f, 8>,
    // From the camera's coordinates to those of the shadow map: across, down, and depth.
    shadow: array<vec4f, 3>,
    // Where the view's pixels begin in the masks of things alone, words per pixel, pixels across.
    counts: vec4u,
}

@group(0) @binding(0) var<uniform> view: View;

struct Corner {
    @location(0) position: vec3f,
    @location(1) face: vec3f,
    @location(2) normal: vec4f,
    @location(3) uv: vec2f,
    @location(4) colour: vec4f,
    @location(5) kind: vec4u,
    // Of the instance: the rows of what takes the mesh to the camera, the camera's place before the mesh, the inverse
    // squares of the scale, the paint, and its id and place in the masks.
    @location(6) row_x: vec4f,
    @location(7) row_y: vec4f,
    @location(8) row_z: vec4f,
    @location(9) eye: vec3f,
    @location(10) unscale: vec3f,
    @location(11) paint: vec3f,
    @location(12) id: u32,
}

fn before_camera(corner: Corner) -> vec3f {
    let position = vec4f(corner.position, 1.0);
    return vec3f(dot(corner.row_x, position), dot(corner.row_y, position), dot(corner.row_z, position));
}

fn turned(corner: Corner, normal: vec3f) -> vec3f {
    let scaled = normal * corner.unscale;
    return vec3f(dot(corner.row_x.xyz, scaled), dot(corner.row_y.xyz, scaled), dot(corner.row_z.xyz, scaled));
}

// Reversed depth without a far plane: near / x.
fn clip(position: vec3f) -> vec4f {
    return vec4f(-position.y * view.project.x, position.z * view.project.y, view.image.w, position.x);
}

// Through the middle of a pixel, 1 long along x.
fn ray(pixel: vec2f) -> vec3f {
    return vec3f(1.0, (view.image.xy - pixel) * view.image.z);
}
