"""More files of the cloud of make.py, with h5py and NumPy alone: python3 make_groups.py FOLDER.

Made with h5py 3.16 (HDF5 2.0).
"""
import h5py, numpy as np, os, sys
os.chdir(sys.argv[1])
N=11
t=np.arange(N,dtype='f4')
pos=np.stack([0.25*t-1, 0.5+0.125*((t*3)%7), -0.375*t],1).astype('f4')
vel=np.stack([1.5-t,0.0625*t,np.full(N,-2,'f4')],1).astype('f4')
rho=(1000+0.5*t).astype('f4'); ids=(500-40*np.arange(N)).astype('u4')
# A group for each vector, with its components, as openPMD writes it.
def split(g,name,v):
    for k,n in enumerate('xyz'): g[f'{name}/{n}']=v[:,k].copy()
with h5py.File('components.h5','w') as f:
    g=f.create_group('particles'); g['id']=ids; g['density']=rho
    for n,v in (('force',5*pos),('positions',pos),('velocities',vel),('probes',pos[:4])): split(g,n,v)
with h5py.File('velocity_group.h5','w') as f: f['position']=pos; f['id']=ids; f['density']=rho; split(f,'velocity',vel)
# Groups of x, y and z that are particles.
with h5py.File('bare.h5','w') as f: split(f,'water',pos); split(f,'floor',pos+np.float32([9,0,0]))
# A step number beside the time.
with h5py.File('step_time.h5','w') as f: f['position']=np.stack([pos,pos+np.float32([1,0,0])]); f['step']=np.array([0,100]); f['time']=np.array([0,0.5])
# As netCDF packs numbers.
def packed(f,name,v,dtype='i2',**attrs):
    d=f.create_dataset(name,data=np.round((v-attrs.get('add_offset',0))/attrs.get('scale_factor',1)).astype(dtype))
    for n,a in attrs.items(): d.attrs[n]=a
with h5py.File('packed.h5','w') as f:
    packed(f,'position',pos,scale_factor=np.array([0.125]),add_offset=np.array([-4.0]))
    packed(f,'velocity',vel,scale_factor=np.float32(0.0625)); packed(f,'density',rho,'f4',scale_factor=0.5,add_offset=1000.0); f['id']=ids
    packed(f,'depth',np.where(t==3,-1,2*t),scale_factor=2.0); d=f['depth']; d[3]=-99; d.attrs['_FillValue']=np.array([-99],'i2')
with h5py.File('badly_packed.h5','w') as f: f['position']=pos; f['position'].attrs['scale_factor']='two'
