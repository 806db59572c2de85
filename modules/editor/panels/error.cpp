// The tab "Error": the mask of the active light compared with its reference.

#include "modules/editor/editor_context.h"

#include "shared/heat_map_shared.h"

#include <imgui.h>

#include <algorithm>

namespace gnomon {

namespace {

void draw_row(const char *p_name, const ErrorMetrics &p_metrics) {
	ImGui::TableNextRow();
	ImGui::TableNextColumn();
	ImGui::TextUnformatted(p_name);
	for (const double value : { p_metrics.mae, p_metrics.rmse, p_metrics.p99, p_metrics.bias }) {
		ImGui::TableNextColumn();
		ImGui::Text("%.4f", value);
	}
	ImGui::TableNextColumn();
	ImGui::Text("%.1f %%", 100.0 * p_metrics.wrong.value_or(0.0)); // the ErrorMeter always sets it
}

void draw_metrics(const MaskMetrics &p_metrics) {
	const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp;
	if (ImGui::BeginTable("metrics", 6, flags)) {
		for (const char *heading : { "", "mean", "RMSE", "99 %", "bias", "wrong" }) {
			ImGui::TableSetupColumn(heading);
		}
		ImGui::TableHeadersRow();
		draw_row("penumbra", p_metrics.penumbra);
		draw_row("receivers", p_metrics.receiver);
		ImGui::EndTable();
	}
	ImGui::TextDisabled("%.0f penumbra pixels; umbra over: %.1f %%",
			double(p_metrics.penumbra.pixel_count), 100.0 * p_metrics.umbra_over);
}

/// Draws the controls of the reference's tracing, and how precise the reference is so far.
void draw_reference(EditorContext &r_context) {
	ErrorState &state = r_context.error;
	if (ImGui::Button(state.is_stopped ? "Start" : "Stop")) {
		state.is_stopped = !state.is_stopped;
	}
	r_context.record_item_rect("button reference");
	if (ImGui::IsItemHovered()) {
		ImGui::SetTooltip("The reference is traced in the background while this tab or the view "
						  "\"error\" is open");
	}
	ImGui::SameLine();
	ImGui::SetNextItemWidth(6.0f * ImGui::GetFontSize());
	if (ImGui::BeginCombo("rays", std::to_string(state.sample_count).c_str())) {
		for (const uint32_t count : ErrorState::SAMPLE_COUNTS) {
			if (ImGui::Selectable(std::to_string(count).c_str(), count == state.sample_count)) {
				state.sample_count = count;
			}
		}
		ImGui::EndCombo();
	}
	ImGui::SameLine();
	if (state.is_tracing) {
		const std::string label = std::to_string(state.round_sample_count) + " rays per pixel";
		ImGui::ProgressBar(state.progress, ImVec2(-1.0f, 0.0f), label.c_str());
	} else if (r_context.document.get_timeline().is_playing()) {
		ImGui::TextDisabled("measured when paused");
	} else if (!state.reference) {
		ImGui::TextDisabled(state.is_stopped ? "no reference" : "measuring the cost");
	} else {
		ImGui::TextDisabled("%.1f s", state.round.seconds);
	}
	if (state.reference) {
		ImGui::Text("Reference: %u rays per pixel, standard error", state.round.sample_count);
		ImGui::SameLine();
		if (state.round.standard_error < 0.0f) {
			ImGui::TextUnformatted("unknown");
		} else {
			ImGui::Text("%.4f", double(state.round.standard_error));
		}
	}
}

void draw_cost(const ErrorState &p_state) {
	if (p_state.cost.frame_count > 0) {
		ImGui::Text("Cost: %.2f ms", p_state.cost.cost_ms);
		ImGui::SameLine();
		ImGui::TextDisabled("median of %u frames", p_state.cost.frame_count);
	}
}

void draw_image(EditorContext &r_context, const char *p_name, void *p_image, ImVec2 p_size) {
	ImGui::BeginGroup();
	ImGui::TextUnformatted(p_name);
	if (p_image != nullptr) {
		ImGui::Image(p_image, p_size);
	} else {
		ImGui::Dummy(p_size);
	}
	ImGui::EndGroup();
	r_context.record_item_rect(std::string("image ") + p_name);
}

/// Draws the image of a debug view. A click shows that view in the viewport; another click switches
/// back to the lit image.
void draw_view(EditorContext &r_context, const char *p_view, void *p_image, ImVec2 p_size) {
	draw_image(r_context, p_view, p_image, p_size);
	if (ImGui::IsItemClicked()) {
		ViewportState &viewport = r_context.viewport;
		viewport.debug_view = viewport.debug_view == p_view ? "" : p_view;
		viewport.needs_redraw = true;
	}
}

/// Draws mask, reference and their difference side by side, as large as possible.
void draw_error_images(EditorContext &r_context) {
	const ErrorState &state = r_context.error;
	const ImVec2 space = ImGui::GetContentRegionAvail();
	const float gap = ImGui::GetStyle().ItemSpacing.x;
	const glm::vec2 size_px = state.mask.size_px;
	if (size_px.x < 1.0f || size_px.y < 1.0f) {
		return;
	}
	const float height = std::max(space.y - ImGui::GetTextLineHeightWithSpacing(), 16.0f);
	const float width = std::max((space.x - 2.0f * gap) / 3.0f, 16.0f);
	const float scale = std::min(width / size_px.x, height / size_px.y);
	const ImVec2 size(size_px.x * scale, size_px.y * scale);
	draw_view(r_context, "mask", state.mask_texture, size);
	ImGui::SameLine();
	draw_image(
			r_context, "reference mask", state.metrics ? state.reference_texture : nullptr, size);
	ImGui::SameLine();
	draw_view(r_context, "error", state.metrics ? state.error_texture : nullptr, size);
	if (ImGui::IsItemHovered()) {
		ImGui::SetTooltip(
				"Mask minus reference. Blue: too dark, red: too light, full colour at %.2g",
				double(HEAT_MAP_RANGE));
	}
}

} // namespace

void draw_error(EditorContext &r_context) {
	ErrorState &state = r_context.error;
	state.is_shown = r_context.begin_tab("Error");
	if (!state.is_shown) {
		return;
	}
	ImGui::BeginChild("figures", ImVec2(26.0f * ImGui::GetFontSize(), 0.0f));
	if (!state.refusal.empty()) {
		ImGui::TextWrapped("%s", state.refusal.c_str());
	} else {
		ImGui::TextUnformatted(state.light.c_str());
		ImGui::SameLine();
		ImGui::TextDisabled("%s", state.technique.c_str());
		draw_reference(r_context);
		draw_cost(state);
		if (state.metrics) {
			draw_metrics(*state.metrics);
		}
	}
	ImGui::EndChild();
	ImGui::SameLine();
	ImGui::BeginChild("images");
	if (state.refusal.empty()) {
		draw_error_images(r_context);
	}
	ImGui::EndChild();
	ImGui::EndTabItem();
}

} // namespace gnomon
