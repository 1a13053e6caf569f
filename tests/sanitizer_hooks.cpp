// Preloaded under the leak sanitizer: libraries stay loaded, so that it can say, and its suppressions can match, whose memory is left over.
// A driver that was unloaded has no name any more.
extern "C" int dlclose(void*);
extern "C" __attribute__((visibility("default"))) int dlclose(void*) { return 0; }
