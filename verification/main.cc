// The program: commands from src/app, published tables from the folders beside this file.
#include "app/launch.h"
#include "app/program.h"
#include "verification/tables.h"

int main(int argc, char** argv) {
  wisp::Engine engine;
  engine.tables = wisp::verification_tables();
  return wisp::program(argc, argv, engine);
}
