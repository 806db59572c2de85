#include "modules/main/overlay_text.h"

#include <algorithm>
#include <cstring>

// The header defines static functions, not all of which are called here.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace gnomon {

namespace {

constexpr float MARGIN_PX = 6.0f;
constexpr float LINE_HEIGHT = 12.0f; // in font pixels
const glm::vec4 PANEL_COLOR(0.0f, 0.0f, 0.0f, 0.6f);
const glm::vec4 TEXT_COLOR(1.0f, 1.0f, 1.0f, 1.0f);

/// The vertex layout of stb_easy_font: position and RGBA8 colour.
struct FontVertex {
	float x, y, z;
	unsigned char color[4];
};
static_assert(sizeof(FontVertex) == 16);

void add_quad(std::vector<OverlayVertex> &r_vertices, const glm::vec2 (&p_corners)[4],
		const glm::vec4 &p_color) {
	for (int corner : { 0, 1, 2, 0, 2, 3 }) {
		r_vertices.push_back({ p_corners[corner], p_color });
	}
}

} // namespace

std::vector<OverlayVertex> make_overlay_text(
		const std::vector<std::string> &p_lines, float p_scale) {
	std::vector<OverlayVertex> text_vertices;
	float width = 0; // of the longest line, in font pixels
	float y = 0;	 // top of the line, in font pixels
	for (const std::string &line : p_lines) {
		std::string ascii;
		std::copy_if(line.begin(), line.end(), std::back_inserter(ascii),
				[](char p_letter) { return p_letter >= 32 && p_letter < 127; });
		// stb_easy_font needs about 270 bytes per character.
		std::vector<char> buffer(ascii.size() * 300 + 300);
		const int quad_count = stb_easy_font_print(
				0, 0, ascii.data(), nullptr, buffer.data(), static_cast<int>(buffer.size()));
		for (int quad = 0; quad < quad_count; ++quad) {
			FontVertex corners[4];
			std::memcpy(corners, buffer.data() + quad * sizeof(corners), sizeof(corners));
			glm::vec2 positions_px[4];
			for (int corner = 0; corner < 4; ++corner) {
				positions_px[corner] =
						MARGIN_PX + p_scale * glm::vec2(corners[corner].x, corners[corner].y + y);
			}
			add_quad(text_vertices, positions_px, TEXT_COLOR);
		}
		width = std::max(width, float(stb_easy_font_width(ascii.data())));
		y += LINE_HEIGHT;
	}
	const glm::vec2 size_px = p_scale * glm::vec2(width, y) + 2.0f * MARGIN_PX;
	const glm::vec2 panel[4] = { { 0, 0 }, { size_px.x, 0 }, size_px, { 0, size_px.y } };
	std::vector<OverlayVertex> vertices;
	add_quad(vertices, panel, PANEL_COLOR);
	vertices.insert(vertices.end(), text_vertices.begin(), text_vertices.end());
	return vertices;
}

} // namespace gnomon
