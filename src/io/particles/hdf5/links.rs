//! Finds the external links of a group, which lead to other HDF5 files. They are not followed.

use hdf5_reader::Hdf5File;
use hdf5_reader::btree_v2::{BTreeV2Header, BTreeV2Record, collect_btree_v2_records_storage};
use hdf5_reader::error::Error;
use hdf5_reader::fractal_heap::FractalHeap;
use hdf5_reader::group::Group;
use hdf5_reader::io::Cursor;
use hdf5_reader::messages::HdfMessage;
use hdf5_reader::messages::link::{LinkMessage, LinkTarget, parse};
use hdf5_reader::messages::link_info::LinkInfoMessage;

/// The external links of a group at a path, in words.
pub(super) fn external(file: &Hdf5File, group: &Group, path: &str) -> Result<Vec<String>, Error> {
    let header = file.get_or_parse_header(group.address())?;
    let mut links = Vec::new();
    for message in &header.messages {
        match message {
            HdfMessage::Link(link) => links.push(link.clone()),
            HdfMessage::LinkInfo(info) => links.extend(dense(group, info)?),
            _ => {}
        }
    }
    let told = links.into_iter().filter_map(|link| match link.target {
        LinkTarget::External { filename, path: to } => {
            Some(format!("{path}/{} leads to {to} in {filename}", link.name))
        }
        _ => None,
    });
    Ok(told.collect())
}

/// The links of a group with many, which are stored apart from its header.
fn dense(group: &Group, info: &LinkInfoMessage) -> Result<Vec<LinkMessage>, Error> {
    let (storage, offset, length) = (group.storage(), group.offset_size(), group.length_size());
    if Cursor::is_undefined_offset(info.fractal_heap_address, offset) {
        return Ok(Vec::new());
    }
    let heap = FractalHeap::parse_at_storage(storage, info.fractal_heap_address, offset, length)?;
    let tree =
        BTreeV2Header::parse_at_storage(storage, info.btree_name_index_address, offset, length)?;
    let records =
        collect_btree_v2_records_storage(storage, &tree, offset, length, None, &[], None)?;
    let mut links = Vec::new();
    for record in &records {
        if let BTreeV2Record::LinkNameHash { heap_id, .. } = record {
            let bytes = heap.get_object_storage(heap_id, storage, offset, length)?;
            links.push(parse(&mut Cursor::new(&bytes), offset, length, bytes.len())?);
        }
    }
    Ok(links)
}
