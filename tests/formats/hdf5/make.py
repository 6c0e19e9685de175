"""The cloud of tests/formats/samples as h5py, VTK and meshio write it: python3 make.py FOLDER.

Made with h5py 3.16 (HDF5 2.0), VTK 9.7.2, meshio and NumPy; PySPH as its HDFOutput does.
"""
import h5py, numpy as np, os, shutil, sys, vtk, meshio
from vtk.util.numpy_support import numpy_to_vtk
from vtk.util.vtkAlgorithm import VTKPythonAlgorithmBase
out=sys.argv[1]; os.makedirs(out,exist_ok=True); os.chdir(out)
N=11
t=np.arange(N,dtype='f4')
pos=np.stack([0.25*t-1, 0.5+0.125*((t*3)%7), -0.375*t],1).astype('f4')
vel=np.stack([1.5-t,0.0625*t,np.full(N,-2,'f4')],1).astype('f4')
rho=(1000+0.5*t).astype('f4'); ids=(500-40*np.arange(N)).astype('u4')
# PySPH: pysph/solver/output.py, HDFOutput
def pysph(name,time):
    with h5py.File(name,'w') as f:
        s=f.create_group('solver_data'); g=f.create_group('particles')
        for ptype,off in (('fluid',0),('boundary',5)):
            p=g.create_group(ptype); a=p.create_group('arrays'); c=p.create_group('constants')
            c.create_dataset('c0',data=np.array([10.0]))
            d={'x':pos[:,0]+off,'y':pos[:,1],'z':pos[:,2],'u':vel[:,0],'v':vel[:,1],'w':vel[:,2],'rho':rho,'gid':ids,'h':np.full(N,0.1),'tag':np.zeros(N,'i4')}
            for k,v in d.items():
                v=v.astype('f8') if k not in('gid','tag') else v
                q=a.create_dataset(k,data=v,compression='gzip',compression_opts=9)
                q.attrs['stored']=True; q.attrs['name']=k; q.attrs['type']='double'; q.attrs['default']=0.0; q.attrs['stride']=1
            q=a.create_dataset('au',(0,)); q.attrs['stored']=False; q.attrs['name']='au'; q.attrs['type']='double'; q.attrs['default']=0.0
        s.attrs['t']=time; s.attrs['dt']=1e-3; s.attrs['count']=7
pysph('pysph.hdf5',0.25)
def poly(k,pos=pos):
    p=vtk.vtkPolyData(); pts=vtk.vtkPoints(); moved=pos.copy(); moved[:,0]+=k
    pts.SetData(numpy_to_vtk(moved,deep=1)); p.SetPoints(pts)
    verts=vtk.vtkCellArray()
    for i in range(len(pos)): verts.InsertNextCell(1,[i])
    p.SetVerts(verts)
    for n,d in (('velocity',vel[:len(pos)]),('density',rho[:len(pos)]),('id',ids[:len(pos)])):
        v=numpy_to_vtk(d,deep=1); v.SetName(n); p.GetPointData().AddArray(v)
    return p
class Source(VTKPythonAlgorithmBase):
    def __init__(s): VTKPythonAlgorithmBase.__init__(s,nInputPorts=0,nOutputPorts=1,outputType='vtkPolyData')
    T=[0.0,0.5,1.0]
    def RequestInformation(s,r,i,o):
        info=o.GetInformationObject(0); ex=vtk.vtkStreamingDemandDrivenPipeline
        info.Set(ex.TIME_STEPS(),s.T,3); info.Set(ex.TIME_RANGE(),[0.0,1.0],2); return 1
    def RequestData(s,r,i,o):
        info=o.GetInformationObject(0); ex=vtk.vtkStreamingDemandDrivenPipeline
        t=info.Get(ex.UPDATE_TIME_STEP()) if info.Has(ex.UPDATE_TIME_STEP()) else 0.0
        k=s.T.index(t); vtk.vtkPolyData.GetData(info).ShallowCopy(poly(k,pos[:N-k])); vtk.vtkPolyData.GetData(info).GetInformation().Set(vtk.vtkDataObject.DATA_TIME_STEP(),t); return 1
w=vtk.vtkHDFWriter(); w.SetFileName('steps.vtkhdf'); src=Source(); w.SetInputConnection(src.GetOutputPort()); w.SetWriteAllTimeSteps(True); w.SetChunkSize(64); w.SetCompressionLevel(4); print('steps',w.Write())
# Offsets of which no chunk was ever written.
shutil.copy('steps.vtkhdf','sparse.vtkhdf')
with h5py.File('sparse.vtkhdf','r+') as f: s=f['VTKHDF/Steps']; del s['PartOffsets']; s.create_dataset('PartOffsets',shape=(1<<32,),chunks=(64,),dtype='i8')
g=vtk.vtkUnstructuredGrid(); p=poly(0); g.SetPoints(p.GetPoints())
for i in range(N): g.InsertNextCell(vtk.VTK_VERTEX,1,[i])
for k in range(3): g.GetPointData().AddArray(p.GetPointData().GetArray(k))
w=vtk.vtkHDFWriter(); w.SetFileName('grid.vtkhdf'); w.SetInputData(g); w.SetChunkSize(64); print('grid',w.Write())
mb=vtk.vtkPartitionedDataSetCollection(); 
a,b=poly(0,pos[:5]),vtk.vtkPolyData()
# XDMF by meshio, a series and a single one
with meshio.xdmf.TimeSeriesWriter('series.xdmf') as m:
    m.write_points_cells(pos,[('vertex',np.arange(N).reshape(-1,1))])
    for k,tt in enumerate((0.0,0.5)): m.write_data(tt,point_data={'velocity':vel*(1+k),'density':rho,'id':ids})
meshio.write('cloud.xdmf',meshio.Mesh(pos,[('vertex',np.arange(N).reshape(-1,1))],point_data={'velocity':vel,'density':rho,'id':ids}))
with h5py.File('steps.h5part','w') as f:
    for k in (0,1,10,2):
        s=f.create_group(f'Step#{k}'); s.attrs['TimeValue']=0.1*k
        for n,d in (('x',pos[:,0]+k),('y',pos[:,1]),('z',pos[:,2]),('vx',vel[:,0]),('vy',vel[:,1]),('vz',vel[:,2]),('rho',rho),('id',ids)): s.create_dataset(n,data=d)
with h5py.File('h5md.h5','w') as f:
    f.create_group('h5md'); g=f.create_group('particles/water')
    for n,d in (('position',np.stack([pos,pos+[1,0,0]])),('velocity',np.stack([vel,vel])),('id',np.stack([ids,ids]))):
        q=g.create_group(n); q.create_dataset('value',data=d.astype(d.dtype if n=='id' else 'f4')); q.create_dataset('step',data=np.array([0,10])); q.create_dataset('time',data=np.array([0,0.5]))
with h5py.File('plain.h5','w',libver='latest') as f:
    f.create_dataset('POSITIONS',data=pos,chunks=(4,3),shuffle=True,compression='gzip',fletcher32=True); f['VELOCITIES']=vel.astype('>f4'); f['DENSITY']=rho; f['IDS']=ids; f['name']='cloud'
# Arrays with one dimension more, and a table.
with h5py.File('stacked.h5','w') as f:
    g=f.create_group('run'); g['x']=np.stack([pos,pos+np.float32([1,0,0])]); g['v']=np.stack([vel,vel]); g['rho']=np.stack([rho,rho]); g['ids']=ids; g['time']=np.array([0,0.5])
with h5py.File('turned.h5','w') as f: f['pos']=pos.T.copy(); f['vel']=vel.T.copy(); f['rho']=rho; f['ids']=ids
with h5py.File('apart.h5','w') as f:
    for k,n in enumerate('xyz'): f['position_'+n]=np.stack([pos[:,k],pos[:,k]+(k==0)]); f['velocity_'+n]=np.stack([vel[:,k]]*2)
    f['ids']=ids; f['time']=np.array([0,0.5])
with h5py.File('numbered.h5','w') as f:
    for k in (0,5):
        for n,off in (('fluid',k/10),('walls',9)): g=f.create_group(f'{k:04d}/{n}'); g['position']=pos+np.float32([off,0,0]); g['velocity']=vel; g['id']=ids
# A time for each of no frames, very often.
with h5py.File('hollow.h5','w') as f: g=f.create_group('particles/water/position'); g['value']=pos[None]; g.create_dataset('time',shape=(1<<60,0),dtype='f8')
with h5py.File('table.h5','w') as f: f['particles']=np.zeros(3,dtype=[('x','f4'),('y','f4'),('z','f4')])
with h5py.File('lzf.h5','w') as f: f.create_dataset('POSITIONS',data=pos,compression='lzf')
# Groups with numbers that count steps, pieces, kinds of particles or anything else.
def groups(name,of,**attrs):
    with h5py.File(name,'w') as f:
        for n,(rows,off) in of.items():
            g=f.create_group(n); g['position']=pos[rows]+np.float32([off,0,0]); g['velocity']=vel[rows]; g['id']=ids[rows]
        for n,time in attrs.items(): f[n].attrs['time']=time
every=slice(None)
groups('ranks.h5',{f't_{t}/rank_{k}':(slice(6*k,6+6*k),t) for t in (0,1.5) for k in (0,1)})
groups('bodies.h5',{'body0':(every,0),'body1':(every,5)})
groups('timed.h5',{'body0':(every,1),'body1':(every,0)},body0=0.5,body1=0.25)
groups('fluids.h5',{'step_0001/fluid1':(slice(0,6),0),'step_0001/fluid2':(slice(6,N),0),'step_0001/walls':(every,5)})
groups('beside.h5',{'floor':(every,5),'step_9':(every,0),'step_10':(every,1)})
with h5py.File('gadget.hdf5','w') as f:
    f.create_group('Header').attrs['Time']=0.25
    for t,off in ((0,0),(1,5)): g=f.create_group(f'PartType{t}'); g['Coordinates']=(pos+[off,0,0]).astype('f8'); g['Velocities']=vel; g['ParticleIDs']=ids.astype('u8'); g['Density']=rho
# Half precision of both byte orders, links, a user block, units.
with h5py.File('half.h5','w') as f: f['position']=pos.astype('<f2'); f['velocity']=vel.astype('>f2'); f.create_dataset('density',data=rho.astype('f2'),chunks=(4,),compression='gzip'); f['id']=ids
with h5py.File('soft.h5','w') as f: f['data/pos']=pos; f['data/rho']=rho; f['position']=h5py.SoftLink('/data/pos'); f['velocity']=vel; f['density']=h5py.SoftLink('/data/rho'); f['id']=ids
with h5py.File('external.h5','w') as f: f['position']=h5py.ExternalLink('plain.h5','/POSITIONS'); f['id']=ids
with h5py.File('externals.h5','w',libver='latest') as f:
    for k in range(30): f[f'step_{k}']=h5py.ExternalLink(f'run_{k:02d}.h5','/')
with h5py.File('partly.h5','w') as f: f['position']=pos; f['velocity']=h5py.ExternalLink('plain.h5','/VELOCITIES')
with h5py.File('matlab.mat','w',userblock_size=512) as f: f['pos']=pos.T.copy(); f['vel']=vel.T.copy(); f['rho']=rho[None]; f['ids']=ids[None].astype('f8'); f['time']=np.array([[0.5]])
with open('matlab.mat','r+b') as f: f.write(b'MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Wed May 01 10:00:00 2024 HDF5 schema 1.00 .'.ljust(116)+b' '*8+b'\x00\x02IM')
with h5py.File('block.h5','w',userblock_size=2048,libver='latest') as f: f['position']=pos; f['velocity']=vel; f['density']=rho; f['id']=ids; f['time']=0.5
with h5py.File('units.h5','w') as f:
    f['position']=pos; f['velocity']=vel; f['density']=rho; f['id']=ids; f['time']=0.5
    for n,u in (('position','mm'),('velocity','mm/s'),('density',np.bytes_('kg/m3')),('id','1'),('time','s')): f[n].attrs['units']=u
