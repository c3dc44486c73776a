/* Open MPI closes its components when it ends. A leak in one of them would then be reported from an "unknown module",
   which no line of leaks.txt can name; so in sanitizer builds nothing is unloaded. */
int dlclose(void* handle);
int dlclose(void* handle) { return handle == 0; }
