// Surfaces in an image of near / z, which is linear over planes.

// Returns the smaller of the two differences to the neighbours along one axis, because the larger one may lead to
// another surface. A neighbour of 0 is background.
float find_smaller_step(float previous, float here, float next) {
	const float back = here - previous;
	const float ahead = next - here;
	return previous <= 0.0 || (next > 0.0 && abs(ahead) < abs(back)) ? ahead : back;
}

float fetch_inside(texture2D depth_texture, ivec2 pixel) {
	const ivec2 size = textureSize(depth_texture, 0);
	return any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))
			? 0.0
			: texelFetch(depth_texture, pixel, 0).r;
}

// Change of near / z per pixel along x and y, on the surface at a pixel.
vec2 find_slope(texture2D depth_texture, ivec2 pixel) {
	const float here = texelFetch(depth_texture, pixel, 0).r;
	const float left = fetch_inside(depth_texture, pixel - ivec2(1, 0));
	const float right = fetch_inside(depth_texture, pixel + ivec2(1, 0));
	const float above = fetch_inside(depth_texture, pixel - ivec2(0, 1));
	const float below = fetch_inside(depth_texture, pixel + ivec2(0, 1));
	return vec2(left > 0.0 || right > 0.0 ? find_smaller_step(left, here, right) : 0.0,
			above > 0.0 || below > 0.0 ? find_smaller_step(above, here, below) : 0.0);
}
