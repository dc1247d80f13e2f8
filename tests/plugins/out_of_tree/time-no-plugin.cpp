// A shared library that has nothing to do with Ricochet.
extern "C" int answer() {
  return 42;
}
