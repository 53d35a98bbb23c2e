// Ends what tracked_begin.h began.
#undef float
#undef NEPHROID_NAMESPACE_BEGIN
#define NEPHROID_NAMESPACE_BEGIN namespace nephroid {
