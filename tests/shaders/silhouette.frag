#version 460
// Writes the mask of edges that silhouette.geom found.
layout(location = 0) flat in uint in_found;
layout(location = 0) out uint out_found;

void main() {
	out_found = in_found;
}
