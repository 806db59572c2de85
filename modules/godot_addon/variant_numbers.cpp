#include "modules/godot_addon/variant_numbers.h"

namespace gnomon {

namespace {

using godot::BuiltInType;

template <typename Array> std::vector<double> read_packed(const godot::Variant &p_value) {
	const Array array(p_value);
	std::vector<double> numbers;
	for (const auto &value : array.get_values()) {
		const auto *first = reinterpret_cast<const float *>(&value);
		numbers.insert(numbers.end(), first, first + sizeof(value) / sizeof(float));
	}
	return numbers;
}

template <typename Vector>
std::vector<double> read_vector(const godot::Variant &p_value, BuiltInType p_type) {
	Vector vector(0);
	p_value.store(p_type, &vector);
	std::vector<double> numbers;
	for (int component = 0; component < Vector::length(); ++component) {
		numbers.push_back(double(vector[component]));
	}
	return numbers;
}

template <typename Matrix> std::vector<double> list_columns(const Matrix &p_matrix) {
	std::vector<double> numbers;
	for (int column = 0; column < Matrix::length(); ++column) {
		for (int row = 0; row < Matrix::col_type::length(); ++row) {
			numbers.push_back(double(p_matrix[column][row]));
		}
	}
	return numbers;
}

std::vector<double> read_matrix(const godot::Variant &p_value, BuiltInType p_type) {
	if (p_type == BuiltInType::PROJECTION) {
		glm::mat4 matrix(0.0f);
		p_value.store(p_type, &matrix);
		return list_columns(matrix);
	}
	if (p_type == BuiltInType::BASIS) {
		glm::mat3 rows(0.0f);
		p_value.store(p_type, &rows);
		return list_columns(glm::transpose(rows));
	}
	return list_columns(p_value.to_transform().to_matrix());
}

} // namespace

std::vector<double> to_numbers(const godot::Variant &p_value) {
	const BuiltInType type = p_value.get_type();
	switch (type) {
		case BuiltInType::BOOL:
		case BuiltInType::INT:
		case BuiltInType::FLOAT:
			return { p_value.to_float() };
		case BuiltInType::VECTOR2:
			return read_vector<glm::vec2>(p_value, type);
		case BuiltInType::VECTOR2I:
			return read_vector<glm::ivec2>(p_value, type);
		case BuiltInType::VECTOR3:
			return read_vector<glm::vec3>(p_value, type);
		case BuiltInType::VECTOR3I:
			return read_vector<glm::ivec3>(p_value, type);
		case BuiltInType::VECTOR4:
		case BuiltInType::COLOR:
			return read_vector<glm::vec4>(p_value, type);
		case BuiltInType::VECTOR4I:
			return read_vector<glm::ivec4>(p_value, type);
		case BuiltInType::BASIS:
		case BuiltInType::TRANSFORM3D:
		case BuiltInType::PROJECTION:
			return read_matrix(p_value, type);
		case BuiltInType::PACKED_FLOAT32_ARRAY:
			return read_packed<godot::PackedFloat32Array>(p_value);
		case BuiltInType::PACKED_VECTOR2_ARRAY:
			return read_packed<godot::PackedVector2Array>(p_value);
		case BuiltInType::PACKED_VECTOR3_ARRAY:
			return read_packed<godot::PackedVector3Array>(p_value);
		case BuiltInType::PACKED_COLOR_ARRAY:
			return read_packed<godot::PackedColorArray>(p_value);
		case BuiltInType::PACKED_INT32_ARRAY: {
			const godot::PackedInt32Array array(p_value);
			return { array.get_values().begin(), array.get_values().end() };
		}
		default:
			return {};
	}
}

} // namespace gnomon
