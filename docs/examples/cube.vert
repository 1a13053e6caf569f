// A cube of 36 corners without any buffers, lit from its sides' directions.
#version 450
layout(push_constant) uniform Push { mat4 clip_from_cube; } push;
layout(location = 0) out vec3 colour;
void main() {
    const int face = gl_VertexIndex / 6, axis = face % 3, corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexIndex % 6];
    vec3 at;
    at[axis] = face < 3 ? 0.5 : -0.5;
    at[(axis + 1) % 3] = float(corner & 1) - 0.5;
    at[(axis + 2) % 3] = float(corner >> 1) - 0.5;
    colour = vec3(0.9, 0.6, 0.2) * (0.4 + 0.2 * float(face % 3));
    gl_Position = push.clip_from_cube * vec4(at, 1);
}
