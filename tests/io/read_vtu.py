"""Opens the sample files with VTK's own reader and compares every array with the bytes that were to be written.

Runs in a process of its own: VTK brings a serial HDF5 that must not meet the engine's.
"""
import os
import sys
import unittest
import xml.etree.ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

FOLDER = ""


def read(name):
    parallel = name.endswith(".pvtu")
    reader = vtkXMLPUnstructuredGridReader() if parallel else vtkXMLUnstructuredGridReader()
    problems = []
    reader.AddObserver("ErrorEvent", lambda *_: problems.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: problems.append("warning"))
    reader.SetFileName(os.path.join(FOLDER, name))
    assert reader.CanReadFile(os.path.join(FOLDER, name)), name
    reader.Update()
    assert not problems, (name, problems)
    return reader.GetOutput()


def expected(name, array):
    with open(os.path.join(FOLDER, "expected", f"{name}.{array}.bin"), "rb") as stream:
        return stream.read()


class ReadByVtk(unittest.TestCase):
    arrays = ["displacement", "stress", "volume", "id", 'a < b & "c"']

    def compare(self, name, count):
        grid = read(name)
        self.assertEqual(grid.GetNumberOfPoints(), count)
        self.assertEqual(grid.GetNumberOfCells(), count)
        fields = grid.GetPointData()
        self.assertEqual([fields.GetArrayName(i) for i in range(fields.GetNumberOfArrays())], self.arrays)
        if count:
            self.assertEqual(vtk_to_numpy(grid.GetPoints().GetData()).tobytes(), expected(name, "Points"))
        for array in self.arrays:
            values = vtk_to_numpy(fields.GetArray(array)) if count else np.zeros(0)
            self.assertEqual(values.tobytes(), expected(name, array), f"{name}: {array}")
        for i in range(min(count, 3)):
            self.assertEqual(grid.GetCellType(i), 1)
            self.assertEqual(grid.GetCell(i).GetPointId(0), i)
        return grid

    def test_sizes(self):
        for name, count in ("empty.vtu", 0), ("one.vtu", 1), ("block.vtu", 131072), ("many.vtu", 150001):
            with self.subTest(name):
                self.compare(name, count)

    def test_names_units_and_time(self):
        grid = self.compare("points-000010.vtu", 400)
        stress = grid.GetPointData().GetArray("stress")
        self.assertEqual([stress.GetComponentName(i) for i in range(4)], ["xx", "yy", "zz", "xy"])
        self.assertEqual(stress.GetInformation().Get(vtkDataArray.UNITS_LABEL()), "Pa")
        self.assertEqual(grid.GetFieldData().GetArray("TimeValue").GetValue(0), 0.1)
        self.assertEqual(grid.GetFieldData().GetArray("step").GetValue(0), 10)

    def test_pieces_of_ranks(self):
        self.compare("points-000030.pvtu", 400)

    def test_cells(self):
        grid = read("cells.vtu")
        self.assertEqual([grid.GetCellType(i) for i in range(4)], [9, 5, 12, 4])
        self.assertEqual([grid.GetCell(3).GetPointId(i) for i in range(5)], [4, 5, 6, 7, 4])
        self.assertEqual(vtk_to_numpy(grid.GetCellData().GetArray("active")).tolist(), [1, 0, 1, 0])
        self.assertEqual(vtk_to_numpy(grid.GetPointData().GetArray("node")).tolist(), list(range(8)))

    def test_series(self):
        # The reader of .pvd is ParaView's, not VTK's: the list is examined here, the files by VTK.
        root = xml.etree.ElementTree.parse(os.path.join(FOLDER, "points.pvd")).getroot()
        self.assertEqual(root.get("type"), "Collection")
        entries = [(float(e.get("timestep")), e.get("file")) for e in root.iter("DataSet")]
        self.assertEqual([time for time, _ in entries], [0.0, 0.1, 0.2, 0.3])
        for _, name in entries:
            self.assertEqual(read(name).GetNumberOfPoints(), 400)


if __name__ == "__main__":
    FOLDER = sys.argv.pop(1)
    unittest.main()
