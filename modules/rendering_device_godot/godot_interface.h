#pragma once

#include <gdextension_interface.h>

namespace gnomon::godot {

/// The functions of the engine that hosts the add-on, those that are used; by their names there.
struct Interface {
	GDExtensionInterfaceVariantNewNil variant_new_nil;
	GDExtensionInterfaceVariantNewCopy variant_new_copy;
	GDExtensionInterfaceVariantDestroy variant_destroy;
	GDExtensionInterfaceGetVariantFromTypeConstructor get_variant_from_type_constructor;
	GDExtensionInterfaceGetVariantToTypeConstructor get_variant_to_type_constructor;
	GDExtensionInterfaceVariantGetPtrConstructor variant_get_ptr_constructor;
	GDExtensionInterfaceVariantGetPtrDestructor variant_get_ptr_destructor;
	GDExtensionInterfaceVariantGetPtrBuiltinMethod variant_get_ptr_builtin_method;
	GDExtensionInterfaceStringNewWithUtf8CharsAndLen string_new_with_utf8_chars_and_len;
	GDExtensionInterfaceStringToUtf8Chars string_to_utf8_chars;
	GDExtensionInterfaceStringNameNewWithUtf8Chars string_name_new_with_utf8_chars;
	GDExtensionInterfacePackedByteArrayOperatorIndex packed_byte_array_operator_index;
	GDExtensionInterfacePackedColorArrayOperatorIndex packed_color_array_operator_index;
	GDExtensionInterfaceClassdbConstructObject2 classdb_construct_object2;
	GDExtensionInterfaceClassdbGetMethodBind classdb_get_method_bind;
	GDExtensionInterfaceObjectMethodBindPtrcall object_method_bind_ptrcall;
	GDExtensionInterfaceObjectDestroy object_destroy;
	GDExtensionInterfaceGlobalGetSingleton global_get_singleton;
	GDExtensionInterfaceCallableCustomCreate2 callable_custom_create2;
	GDExtensionInterfaceRegisterMainLoopCallbacks register_main_loop_callbacks;

	GDExtensionClassLibraryPtr extension; // ours, as the engine names it
};

/// Of the add-on's entry point; everything else here needs it. A function that is missing is an
/// Error that names it.
void load_interface(
		GDExtensionInterfaceGetProcAddress p_get_address, GDExtensionClassLibraryPtr p_library);
const Interface &get_interface();

} // namespace gnomon::godot
