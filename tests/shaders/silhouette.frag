#version 460
layout(location = 0) flat in uint in_found;
layout(location = 0) out uint out_found;

void main() {
	out_found = in_found;
}
