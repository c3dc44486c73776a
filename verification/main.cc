// The program: commands from src/app, published tables from the folders beside this file.
#include "app/launch.h"
#include "app/program.h"

int main(int argc, char** argv) {
  wisp::use_one_blas_thread(argv);
  wisp::Engine engine;
  return wisp::program(argc, argv, engine);
}
