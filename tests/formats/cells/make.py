"""The cloud of tests/formats/samples on vertices, as VTK and meshio write it: python3 make.py FOLDER.

Made with VTK 9.7.2, meshio 5.3.5 and NumPy. Cell i has point ORDER[i], in same.vtkhdf point i.
"""
import os, sys

import meshio, numpy as np, vtk
from vtk.util.numpy_support import numpy_to_vtk

os.chdir(sys.argv[1])
N = 11
ORDER = [3, 0, 2, 1, 10, 9, 5, 4, 8, 6, 7]
t = np.arange(N, dtype="f4")
points = np.stack([0.25 * t - 1, 0.5 + 0.125 * ((t * 3) % 7), -0.375 * t], 1).astype("f4")
fields = {
    "velocity": np.stack([1.5 - t, 0.0625 * t, np.full(N, -2, "f4")], 1).astype("f4"),
    "density": (1000 + 0.5 * t).astype("f4"),
    "id": (500 - 40 * np.arange(N)).astype("i4"),
}
cells = {name: field[ORDER] for name, field in fields.items()}

mesh = meshio.Mesh(points, [("vertex", np.array(ORDER)[:, None])], cell_data={n: [f] for n, f in cells.items()})
mesh.write("meshio.vtu")
mesh.write("meshio.vtk")


def write(writer, name, order):
    data = vtk.vtkPolyData()
    own = vtk.vtkPoints()
    own.SetData(numpy_to_vtk(points, deep=1))
    data.SetPoints(own)
    vertices = vtk.vtkCellArray()
    for point in order:
        vertices.InsertNextCell(1, [point])
    data.SetVerts(vertices)
    for field, values in fields.items():
        array = numpy_to_vtk(values[order], deep=1)
        array.SetName(field)
        data.GetCellData().AddArray(array)
    writer.SetInputData(data)
    writer.SetFileName(name)
    writer.Write()


write(vtk.vtkXMLPolyDataWriter(), "vtk.vtp", ORDER)
for name, order in ("same.vtkhdf", list(range(N))), ("other.vtkhdf", ORDER):
    writer = vtk.vtkHDFWriter()
    writer.SetChunkSize(64)
    write(writer, name, order)
