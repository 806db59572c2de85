// Closes what shared_begin.h opened.
#ifdef __cplusplus
} // namespace shader
} // namespace gnomon
#endif
#undef SHARED_ALIGN
#undef SHARED_FUNCTION
#undef SHARED_SIZE
#undef SHARED_OFFSET
